#include "services/withoutscene.h"
#include "services/services.h"
#include "services/table.h"

namespace alpenglow::services {

struct WithoutScene::State {
    std::shared_ptr<const WorldImpl> world;
    std::unique_ptr<Services> answers;
    const rsl::CompiledKernel* kernel = nullptr; ///< the kernel of `bound`
    BoundKernel bound;
    KernelRun context;
};

WithoutScene::WithoutScene(std::vector<std::string> texturePaths, Diagnostics& d) : state_(std::make_unique<State>()) {
    Settings settings;
    settings.texturePaths = std::move(texturePaths);
    state_->world = emptyWorld(settings, serviceTable(), d);
    state_->answers = std::make_unique<Services>(*state_->world, d, nullptr);
}

WithoutScene::~WithoutScene() = default;

void WithoutScene::setPoints(const Vec3& eye, std::span<const Vec3> points) {
    KernelRun& c = state_->context;
    c.points.assign(points.size(), {});
    c.rays.assign(points.size(), {});
    for (size_t i = 0; i < points.size(); ++i) {
        ShadePoint& p = c.points[i];
        p.P = points[i];
        p.E = eye;
        p.I = p.P - eye;
        c.rays[i].origin = eye;
        c.rays[i].dir = normalize(p.I);
    }
}

bool WithoutScene::answer(const rsl::CompiledKernel& k, int32_t site, int32_t first, uint64_t mask, int32_t lanes,
                          const float* in, float* out) {
    if (site < 0) return false;
    const Service* service = findService(serviceTable(), k.sites()[size_t(site)].op);
    if (!service || !(service->traits & kWithoutScene)) return false;
    State& s = *state_;
    if (s.kernel != &k) {
        s.bound = bindKernel(std::shared_ptr<const rsl::CompiledKernel>(std::shared_ptr<const rsl::CompiledKernel>{}, &k), false,
                             false, *s.world);
        s.kernel = &k;
        s.context.bound = &s.bound;
    }
    s.answers->service(s.context, site, first, mask, lanes, in, out);
    return true;
}

} // namespace alpenglow::services
