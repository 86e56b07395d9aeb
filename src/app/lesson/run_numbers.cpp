#include "app/lesson/run_numbers.h"

#include "app/lesson/lesson_scene.h"
#include "core/check.h"
#include "quantities/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

constexpr double same_time = 1e-9;  // s

const SourceLocation& place_of(const StatedNumber& number) { return number.places.of("check"); }

std::vector<Quantity> quantities_of(std::span<const StatedNumber* const> numbers, const SceneDescription& scene) {
    std::vector<Quantity> quantities;
    for (const StatedNumber* number : numbers) {
        if (number->check->of.empty()) continue;
        with_place(place_of(*number), "check", [&] {
            const std::vector<Quantity> one = parse_quantities(number->check->of, scene);
            if (one.size() != 1)
                throw InputError(fmt::format("of: must be one quantity (given {})", number->check->of));
            quantities.push_back(one.front());
        });
    }
    return quantities;
}

struct ImpactColumn {
    std::string_view name;
    double (*value)(const ImpactRecord&);
};
constexpr std::array impact_columns{
    ImpactColumn{"time", [](const ImpactRecord& i) { return i.when.time; }},
    ImpactColumn{"frame", [](const ImpactRecord& i) { return double(i.when.frame); }},
    ImpactColumn{"px", [](const ImpactRecord& i) { return i.point.x(); }},
    ImpactColumn{"py", [](const ImpactRecord& i) { return i.point.y(); }},
    ImpactColumn{"pz", [](const ImpactRecord& i) { return i.point.z(); }},
    ImpactColumn{"nx", [](const ImpactRecord& i) { return i.normal.x(); }},
    ImpactColumn{"ny", [](const ImpactRecord& i) { return i.normal.y(); }},
    ImpactColumn{"nz", [](const ImpactRecord& i) { return i.normal.z(); }},
    ImpactColumn{"v_before", [](const ImpactRecord& i) { return i.speed_before; }},
    ImpactColumn{"v_after", [](const ImpactRecord& i) { return i.speed_after; }},
    ImpactColumn{"restitution", [](const ImpactRecord& i) { return i.restitution; }},
    ImpactColumn{"impulse", [](const ImpactRecord& i) { return i.impulse; }},
    ImpactColumn{"fx", [](const ImpactRecord& i) { return i.friction.x(); }},
    ImpactColumn{"fy", [](const ImpactRecord& i) { return i.friction.y(); }},
    ImpactColumn{"fz", [](const ImpactRecord& i) { return i.friction.z(); }},
    ImpactColumn{"pass", [](const ImpactRecord& i) { return double(i.pass); }},
};

double of_impact(const StatedNumber& number, const PageRun& run) {
    const LessonCheck& check = *number.check;
    if (!check.impact) return double(run.all_impacts);
    if (*check.impact > run.impacts.size())
        throw InputError(place_of(number), fmt::format("check: the run has {} impacts (asked for impact {})",
                                                       run.impacts.size(), *check.impact));
    const auto column = std::ranges::find(impact_columns, check.column, &ImpactColumn::name);
    if (column == impact_columns.end())
        throw InputError(place_of(number), fmt::format("check: impacts have no column '{}'", check.column));
    return column->value(run.impacts[*check.impact - 1].record);
}

}  // namespace

CheckedRun::CheckedRun(std::span<const StatedNumber* const> numbers, const SceneDescription& scene)
    : numbers_(numbers.begin(), numbers.end()), values_("", quantities_of(numbers, scene)) {
    std::size_t next = 0;
    for (const StatedNumber* number : numbers_) quantity_of_.push_back(number->check->of.empty() ? 0 : next++);
}

double CheckedRun::measured(std::size_t index, const PageRun& run) const {
    const StatedNumber& number = *numbers_[index];
    return number.check->of.empty() ? of_impact(number, run) : of_time(number, quantity_of_[index]);
}

double CheckedRun::of_time(const StatedNumber& number, std::size_t quantity) const {
    const LessonCheck& check = *number.check;
    const std::vector<double>& times = values_.times;
    const std::vector<double>& values = values_.values[quantity];
    if (check.take == "at") {
        if (check.at > times.back() + same_time)
            throw InputError(place_of(number),
                             fmt::format("check: the run ends at {:g} s (at = {:g})", times.back(), check.at));
        const auto nearest =
            std::ranges::min_element(times, {}, [&](double time) { return std::abs(time - check.at); });
        return values[std::size_t(nearest - times.begin())];
    }
    std::vector<double> taken;
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i] >= check.from.value_or(0.0) - same_time && times[i] <= check.to.value_or(INFINITY) + same_time)
            taken.push_back(values[i]);
    if (taken.empty())
        throw InputError(place_of(number),
                         fmt::format("check: no frame of the run lies in this time (it ends at {:g} s)", times.back()));
    const auto [least, most] = std::ranges::minmax(taken);
    if (check.take == "max") return most;
    if (check.take == "min") return least;
    if (check.take == "range") return most - least;
    if (check.take == "first") return taken.front();
    if (check.take == "last") return taken.back();
    TUMBLE_CHECK_EQ(check.take, "mean");
    return std::accumulate(taken.begin(), taken.end(), 0.0) / double(taken.size());
}

}  // namespace tumble
