// The soft contact solver's inner loops, 4 lanes (sse2; WebAssembly with vectors, and without).
#include "sim/contact/model/settings.h"
#include "sim/contact/model/spin_friction.h"
#include "sim/contact/soft/settings.h"
#include "sim/contact/soft/soft_joint_rows.h"
#include "sim/contact/soft/soft_kernel.h"

#include <cmath>

#pragma GCC target("sse2")
#ifdef __SSE__
#include <immintrin.h>
#endif

#define TUMBLE_LANES 4

namespace tumble::soft {
namespace {
#include "sim/contact/soft/soft_kernel_lanes.h"
}  // namespace

const Kernel sse2_kernel{TUMBLE_LANES, prepare, warm_start,     accelerate,        move,           correct,     relax,
                         rub,          sum,     prepare_joints, warm_start_joints, correct_joints, relax_joints};

}  // namespace tumble::soft
