// Whether this is the build under AddressSanitizer (./check --asan) or ThreadSanitizer (--tsan). There tests that repeat one
// thing with other random numbers may do it fewer times: what is looked for is a wrong access, and that is the same code in every
// turn.
#pragma once

namespace alpenglow {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

} // namespace alpenglow
