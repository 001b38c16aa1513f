
namespace file_test {} // namespace file_test
