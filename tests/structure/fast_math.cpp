// Compiled with an option that takes infinity and NaN away, a header stops the compiler unless the user insists.

#ifndef MUST_NOT_COMPILE
#define LIGHTSWITCH_ALLOW_FAST_MATH
#endif
#include <lightswitch/core/math.hpp>
