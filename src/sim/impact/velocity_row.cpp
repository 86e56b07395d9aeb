#include "sim/impact/velocity_row.h"

#include <array>

namespace tumble {

// Four sums in turn: they do not wait for each other, and their order is that of the code.
double VelocityRow::product(std::span<const double> numbers, const double* y) {
    double sums[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= numbers.size(); i += 4)
        for (std::size_t k = 0; k < 4; ++k) sums[k] += numbers[i + k] * y[i + k];
    for (; i < numbers.size(); ++i) sums[0] += numbers[i] * y[i];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

double VelocityRow::joined_dot(const VelocityRow& other) const {
    struct Part {
        std::uint32_t place;
        std::span<const double> numbers;
        double sign;
    };
    const auto parts = [](const VelocityRow& row) {
        if (!row.joined)
            return std::array{Part{row.a, {row.on_a.data(), 6}, 1.0}, Part{row.b, {row.on_b.data(), 6}, 1.0}};
        const JoinedRow& groups = *row.joined;
        return std::array{Part{row.a, groups.on_a(), groups.sign}, Part{row.b, groups.on_b(), groups.sign}};
    };
    double sum = 0.0;
    for (const Part& mine : parts(*this))
        for (const Part& its : parts(other))
            if (mine.place != none && mine.place == its.place)
                sum += mine.sign * its.sign * product(mine.numbers, its.numbers.data());
    return sum;
}

double VelocityRow::joined_norm() const { return joined_dot(*this); }

void VelocityRow::joined_add_to(Eigen::VectorXd& y, double amount) const {
    const auto add = [&](std::uint32_t place, std::span<const double> numbers) {
        if (place == none) return;
        double* to = y.data() + 6 * std::size_t(place);
        for (std::size_t i = 0; i < numbers.size(); ++i) to[i] += joined->sign * amount * numbers[i];
    };
    add(a, joined->on_a());
    add(b, joined->on_b());
}

}  // namespace tumble
