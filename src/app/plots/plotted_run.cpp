#include "app/plots/plotted_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace tumble {
namespace {

std::string line_label(const PlottedRun& run, const Quantity& quantity, bool several_runs, bool several_quantities) {
    if (!several_runs) return quantity.label;
    return several_quantities ? fmt::format("{}, {}", quantity.label, run.label) : run.label;
}

}  // namespace

PlottedRun::PlottedRun(std::string run_label, std::vector<Quantity> of_run)
    : label(std::move(run_label)), quantities(std::move(of_run)), values(quantities.size()) {}

SurveyNeeds PlottedRun::needs() const {
    SurveyNeeds needs;
    for (const Quantity& quantity : quantities) needs = needs | quantity.needs;
    return needs;
}

void PlottedRun::see(const Snapshot& snapshot, const Survey& survey, const ContactRecords*) {
    times.push_back(snapshot.time);
    for (std::size_t k = 0; k < quantities.size(); ++k) {
        values[k].push_back(quantities[k].value({snapshot, survey}));
        if (quantities[k].mean_of_frame && times.size() == 2) values[k][0] = values[k][1];
    }
}

void PlottedRun::subtract(const PlottedRun& other) {
    for (std::size_t k = 0; k < values.size(); ++k)
        for (std::size_t i = 0; i < times.size(); ++i) {
            const auto at = std::lower_bound(other.times.begin(), other.times.end(), times[i] - 1e-9);
            const bool has = at != other.times.end() && *at <= times[i] + 1e-9;
            values[k][i] -=
                has ? other.values[k][std::size_t(at - other.times.begin())] : std::numeric_limits<double>::quiet_NaN();
        }
}

std::size_t panels_of(std::span<const Quantity> quantities) {
    std::set<std::string> titles;
    for (const Quantity& quantity : quantities) titles.insert(quantity.panel);
    return titles.size();
}

std::vector<Panel> make_panels(std::span<const PlottedRun> runs, bool several, const PlotStyle& style) {
    std::vector<Panel> panels;
    const auto& quantities = runs.front().quantities;
    for (std::size_t k = 0; k < quantities.size(); ++k) {
        const std::string title = (style.difference ? "difference of " : "") + quantities[k].panel;
        auto panel = std::find_if(panels.begin(), panels.end(), [&](const Panel& p) { return p.title == title; });
        if (panel == panels.end()) {
            panels.push_back({title, style.logarithmic, {}});
            panel = panels.end() - 1;
        }
        const auto same =
            std::ranges::count_if(quantities, [&](const Quantity& q) { return q.panel == quantities[k].panel; });
        for (const PlottedRun& run : runs) {
            Series series{line_label(run, run.quantities[k], several, same > 1), run.times, run.values[k],
                          panel->series.size(), false};
            if (style.difference && style.logarithmic)
                for (double& y : series.y) y = std::fabs(y);
            panel->series.push_back(std::move(series));
        }
    }
    // With a single quantity the panel names its body or joint.
    if (quantities.size() == 1 && !several && quantities[0].of_part)
        panels[0].title = fmt::format("{} of {}", panels[0].title, quantities[0].label);
    return panels;
}

}  // namespace tumble
