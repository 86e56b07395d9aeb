// The soft contact solver's inner loops, 16 lanes (avx512).
#include "sim/contact/model/settings.h"
#include "sim/contact/model/spin_friction.h"
#include "sim/contact/soft/settings.h"
#include "sim/contact/soft/soft_joint_rows.h"
#include "sim/contact/soft/soft_kernel.h"

#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"  // false positive of g++ 12 on its own "undefined" vectors
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <immintrin.h>

#define TUMBLE_LANES 16

namespace tumble::soft {
namespace {
#include "sim/contact/soft/soft_kernel_lanes.h"
}  // namespace

const Kernel avx512_kernel{TUMBLE_LANES, prepare, warm_start,     accelerate,        move,           correct,     relax,
                           rub,          sum,     prepare_joints, warm_start_joints, correct_joints, relax_joints};

}  // namespace tumble::soft
#pragma GCC diagnostic pop
