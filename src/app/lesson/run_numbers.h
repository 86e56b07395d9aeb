// Numbers of runs that quizzes and measures are compared with.
#pragma once

#include "app/lesson/course.h"
#include "app/plots/plotted_run.h"
#include "page/page_run.h"

#include <span>

namespace tumble {

/// The values that the checks need of one run. The quantities of all checks are seen in one pass.
class CheckedRun {
public:
    /// `checks`: the checks of this run. Throws InputError, with the place of its check, for an unknown quantity.
    CheckedRun(std::span<const StatedNumber* const> numbers, const SceneDescription& scene);

    SurveyObserver& observer() { return values_; }
    /// Value of the stated number of that index. Throws InputError, with its place, if the run has no such number.
    double measured(std::size_t index, const PageRun& run) const;

private:
    double of_time(const StatedNumber& number, std::size_t quantity) const;

    std::vector<const StatedNumber*> numbers_;
    std::vector<std::size_t> quantity_of_;  // by number
    PlottedRun values_;
};

}  // namespace tumble
