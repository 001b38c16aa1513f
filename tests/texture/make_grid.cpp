// Writes a grid of OpenVDB for the tests: make_test_grid FILE. "density" of 6 x 5 x 4 voxels from (-1, 2, 3) on is x + 10 y + 100
// z, counted from there; "v" is (x, y, z).
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

int main(int argc, char** argv) {
    if (argc < 2) return 1;
    // One thread: ThreadSanitizer does not see how the tasks of Debian's libtbb follow each other.
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    openvdb::initialize();
    auto density = openvdb::FloatGrid::create(0);
    density->setName("density");
    auto v = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    v->setName("v");
    auto a = density->getAccessor();
    auto b = v->getAccessor();
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 6; ++x) {
                a.setValue({x - 1, y + 2, z + 3}, float(x + 10 * y + 100 * z));
                b.setValue({x - 1, y + 2, z + 3}, openvdb::Vec3f(float(x), float(y), float(z)));
            }
    openvdb::io::File(argv[1]).write({density, v});
    return 0;
}
