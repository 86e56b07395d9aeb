// Numbers in the text of a lesson.
#pragma once

#include <string>

namespace tumble {

/// With as many digits as tell it from the expected number at this tolerance, and a true minus sign.
std::string measured_html(double value, double tolerance);
/// A small number of two digits as a power of ten: "3.2 × 10<sup>−12</sup>"; 0 is "0".
std::string power_html(double value);

}  // namespace tumble
