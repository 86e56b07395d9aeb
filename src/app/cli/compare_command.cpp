#include "app/cli/commands.h"
#include "app/cli/compare_sets.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "core/error.h"
#include "tumble/output.h"

#include <fmt/format.h>

#include <string>

namespace tumble {
namespace {

void print(const v0::Comparison& result) {
    const std::string differences =
        fmt::format("{} pixels differ, by {} levels at most", result.differing_pixels, result.max_difference);
    if (!result.alike)
        put("different: {}\n{}, at x {}, y {}\n", result.reason, differences, result.max_column, result.max_row);
    else if (result.differing_pixels == 0)
        put("alike: every pixel is the same\n");
    else
        put("alike: {}\n", differences);
    finish_standard_output();
}

}  // namespace

int run_compare(const CompareCommand& command) {
    const double fraction = command.options.fraction;
    if (!(fraction >= 0.0 && fraction <= 1.0))  // CLI11's range check lets NaN through
        throw InputError(fmt::format("--fraction: must be between 0 and 1 (was {})", fraction));
    if (compares_sets(command)) return compare_sets(command);
    OutputPlan plan;
    for (const auto& image : {command.a, command.b}) plan.add_input(image);
    if (command.difference) plan.add("--diff", *command.difference);
    const v0::Comparison result =
        v0::compare_png_files(command.a, command.b, command.options, command.difference.value_or(""));
    print(result);
    return result.alike ? 0 : 1;
}

}  // namespace tumble
