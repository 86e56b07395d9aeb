// The files of a suite: inputs, and the places of its references.
#pragma once

#include "app/files/output_plan.h"
#include "app/golden/suite.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace tumble {

/// NAME, or PLATFORM/NAME, below the folder of the references.
std::filesystem::path reference_name(const std::string& name, const std::optional<std::string>& platform);

/// The suite's file, its tolerances and masks, the scenes of the cases with all that they read.
void add_suite_inputs(const GoldenSuite& suite, OutputPlan& plan);

/// The folder of the references, as an input.
void add_reference_inputs(const GoldenSuite& suite, OutputPlan& plan);

/// The references of the cases, as outputs. Throws InputError if one would not be below the folder of the references,
/// or if a link leads this folder out of that of the suite.
void add_references(const GoldenSuite& suite, std::span<const GoldenCase* const> cases,
                    const std::optional<std::string>& platform, OutputPlan& plan);

}  // namespace tumble
