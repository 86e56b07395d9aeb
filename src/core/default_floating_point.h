// The state of floating-point arithmetic in functions that other programs call.
#pragma once

#include <cfenv>

namespace tumble {

/// Rounding to nearest and denormal numbers while it lives, then the caller's own again: a program that is built with
/// -ffast-math, or that rounds otherwise, gets the same bytes. New threads inherit the state.
class DefaultFloatingPoint {
public:
    DefaultFloatingPoint() {
        std::fegetenv(&callers_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloatingPoint() { std::fesetenv(&callers_); }
    DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
    DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

private:
    std::fenv_t callers_;
};

}  // namespace tumble
