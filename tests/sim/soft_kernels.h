// The versions of the soft solver's inner loops that a test can compare.
#pragma once

#include "sim/contact/soft/soft_kernel.h"

#include <vector>

namespace tumble::testing {

/// Those for the instruction sets of this processor, the narrowest first.
inline std::vector<const soft::Kernel*> kernels() {
    std::vector<const soft::Kernel*> all = {&soft::sse2_kernel};
    if (__builtin_cpu_supports("avx2")) all.push_back(&soft::avx2_kernel);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        all.push_back(&soft::avx512_kernel);
    return all;
}

}  // namespace tumble::testing
