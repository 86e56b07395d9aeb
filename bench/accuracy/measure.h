// Runs a case: once looked at, for its errors, and as often as it takes for a stable time of stepping.
#pragma once

#include "accuracy/accuracy_case.h"

#include <vector>

namespace tumble::bench {

struct Measured {
    std::vector<Error> errors;
    double cpu = 0.0;    // CPU seconds a simulated second, of stepping alone
    double spent = 0.0;  // CPU seconds of the first run, looking included
};

Measured measure(const AccuracyCase& accuracy_case, const Variant& variant, double rate, double seconds, bool timed);

}  // namespace tumble::bench
