#include "sim/spin_limit.h"

#include "sim/tuning.h"

#include <cmath>

namespace tumble {

bool spin_grew(const Body& body, double before) { return spin(body) > (1.0 + tuning::spin_growth) * before; }

void limit_spin(Body& body, double before) {
    body.angular_momentum *= std::sqrt(before / spin(body));
    body.derive_velocities();
}

}  // namespace tumble
