#include "accuracy/accuracy_case.h"

namespace tumble::bench {

std::vector<double> ladder(double finest) {
    std::vector<double> rates;
    for (double rate = 30.0; rate <= finest; rate *= 2.0) rates.push_back(rate);
    return rates;
}

std::vector<AccuracyCase> accuracy_cases() {
    std::vector<AccuracyCase> cases;
    add_flights(cases);
    add_bounces(cases);
    add_crowds(cases);
    add_rows(cases);
    return cases;
}

}  // namespace tumble::bench
