// Runs a case: once with observation, for its errors, and repeatedly until the time of stepping is stable.
#pragma once

#include "accuracy/accuracy_case.h"

#include <vector>

namespace tumble::bench {

struct Measured {
    std::vector<Error> errors;
    double cpu = 0.0;    // CPU seconds per simulated second, of stepping alone
    double spent = 0.0;  // CPU seconds of the first run, with observation
};

Measured measure(const AccuracyCase& accuracy_case, const Variant& variant, double rate, double seconds, bool timed);

}  // namespace tumble::bench
