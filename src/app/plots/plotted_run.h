// The values of quantities over a run, and the panels of a plot of several runs.
#pragma once

#include "app/survey/survey.h"
#include "plot/figure.h"
#include "quantities/quantities.h"

#include <span>
#include <string>
#include <vector>

namespace tumble {

class PlottedRun : public SurveyObserver {
public:
    /// `label`: its name among several runs.
    PlottedRun(std::string label, std::vector<Quantity> quantities);

    SurveyNeeds needs() const override;
    void see(const Snapshot& snapshot, const Survey& survey, const ContactRecords*) override;

    /// Subtracts the values of another run at the same times; nothing is left where that has none.
    void subtract(const PlottedRun& other);

    std::string label;
    std::vector<Quantity> quantities;
    std::vector<double> times;                // s
    std::vector<std::vector<double>> values;  // by quantity; means over frames have the second one's at the first
};

/// How many panels the quantities take.
std::size_t panels_of(std::span<const Quantity> quantities);

struct PlotStyle {
    bool logarithmic = false;
    bool difference = false;  // the values are differences to another run
};

/// A panel for each unit, and a series for each run and quantity. Runs are told apart by their labels only if there are
/// `several`. Precondition: the runs have the same quantities, of their own scenes.
std::vector<Panel> make_panels(std::span<const PlottedRun> runs, bool several, const PlotStyle& style = {});

}  // namespace tumble
