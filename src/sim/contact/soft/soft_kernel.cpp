#include "sim/contact/soft/soft_kernel.h"

#include <cstdlib>
#include <cstring>

namespace tumble::soft {

const Kernel& best_kernel() {
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    const bool avx2 = __builtin_cpu_supports("avx2");
    const char* asked = std::getenv("TUMBLE_LANES");
    if (avx512 && !(asked && std::strcmp(asked, "16") != 0)) return avx512_kernel;
    if (avx2 && !(asked && std::strcmp(asked, "4") == 0)) return avx2_kernel;
    return sse2_kernel;
}

}  // namespace tumble::soft
