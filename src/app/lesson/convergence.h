// Errors of integrators against the step: the runs, and the fitted slopes.
#pragma once

#include "app/lesson/course.h"
#include "app/threads/interrupt.h"
#include "scene/load.h"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct ConvergenceLine {
    std::string integrator;
    std::vector<double> steps, errors;  // s, and in the unit of the quantity; ascending steps
    std::optional<double> slope;        // of log(error) over log(step); none if rounding is most of the errors
};

/// Every run loaded, so that mistakes come before the first one starts.
struct ConvergenceRuns {
    std::vector<std::vector<SceneDescription>> scenes;  // by integrator and number of steps
    std::optional<SceneDescription> reference;
};

/// Throws InputError with a place in the lesson.
ConvergenceRuns load_convergence(const LessonConvergence& block, FileList& read);

/// Throws InputError, with a place in the lesson, for a slope that is not as stated.
std::vector<ConvergenceLine> run_convergence(const LessonConvergence& block, const ConvergenceRuns& runs,
                                             Interrupt& interrupt);

}  // namespace tumble
