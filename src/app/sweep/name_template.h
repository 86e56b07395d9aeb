// Names of the folders of samples: a text with fields in braces, as in "train/{index:06}_{friction}".
#pragma once

#include "app/sweep/sweep_sample.h"

#include <string>

namespace tumble {

/// Throws InputError where the template is no relative path of a folder, or has an unknown field.
void check_name_template(const SweepPlan& plan);

/// The folder of the sample, whose values must be there. Characters of values other than letters, digits, '.', '+' and
/// '-' become '_'.
std::string name_of_sample(const SweepPlan& plan, const SweepSample& sample);

/// True if the fields tell any two samples apart.
bool names_each_index(const SweepPlan& plan);

}  // namespace tumble
