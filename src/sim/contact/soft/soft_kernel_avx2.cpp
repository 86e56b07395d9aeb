// The soft contact solver's inner loops, 8 lanes (avx2).
#include "sim/contact/model/settings.h"
#include "sim/contact/model/spin_friction.h"
#include "sim/contact/soft/settings.h"
#include "sim/contact/soft/soft_joint_rows.h"
#include "sim/contact/soft/soft_kernel.h"

#pragma GCC target("avx2")
#include <immintrin.h>

#define TUMBLE_LANES 8

namespace tumble::soft {
namespace {
#include "sim/contact/soft/soft_kernel_lanes.h"
}  // namespace

const Kernel avx2_kernel{TUMBLE_LANES, prepare, warm_start,     accelerate,        move,           correct,     relax,
                         rub,          sum,     prepare_joints, warm_start_joints, correct_joints, relax_joints};

}  // namespace tumble::soft
