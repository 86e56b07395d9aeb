// The axis of a plot: its range, the places of its ticks and their labels.
#pragma once

#include <string>
#include <vector>

namespace tumble {

class Axis {
public:
    /// Covers the values from `least` to `most`; `about` ticks. A logarithmic axis needs least > 0.
    static Axis linear(double least, double most, int about);
    /// From `least` to `most` exactly, with the ticks in between.
    static Axis exact(double least, double most, int about);
    static Axis logarithmic(double least, double most, int about);

    struct Tick {
        double value;
        std::string label;
    };
    const std::vector<Tick>& ticks() const { return ticks_; }
    double least() const { return least_; }
    double most() const { return most_; }

    /// Place of a value: 0 at `least`, 1 at `most`; not finite where a logarithm does not exist.
    double place(double value) const;

private:
    bool log_ = false;
    double least_ = 0.0, most_ = 1.0;
    std::vector<Tick> ticks_;
};

}  // namespace tumble
