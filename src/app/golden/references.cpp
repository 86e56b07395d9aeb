#include "app/golden/suite.h"

#include "app/compare/compared_frames.h"
#include "app/plots/variants.h"
#include "core/error.h"
#include "scene/load.h"

#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// A case with a mistake is a result of the suite.
void add_scenes(const GoldenCase& golden, OutputPlan& plan) {
    plan.add_inputs(golden.scenes);
    FileList read;
    try {
        for (const Variant& variant : make_variants(golden.scenes, golden.overrides, golden.vary))
            load_scene(variant.scene, variant.overrides, &read);
    } catch (const InputError&) {
    }
    plan.add_inputs(read);
}

/// A suite names its references' folder, also one elsewhere. A link is not in its text.
void check_reference_folder(const GoldenSuite& suite) {
    const fs::path folder = fs::absolute(suite.file).parent_path().lexically_normal();
    const fs::path below = fs::absolute(suite.references).lexically_normal().lexically_relative(folder);
    if (!below.empty() && *below.begin() != ".." && below != ".") confined_path(folder, below / "reference");
}

}  // namespace

fs::path reference_name(const std::string& name, const std::optional<std::string>& platform) {
    return platform ? fs::path(*platform) / name : fs::path(name);
}

void add_suite_inputs(const GoldenSuite& suite, OutputPlan& plan) {
    plan.add_input(suite.file);
    plan.add_inputs(suite.tolerances.files());
    for (const GoldenCase& golden : suite.cases) {
        if (golden.tolerances) plan.add_inputs(golden.tolerances->files());
        add_scenes(golden, plan);
    }
}

void add_reference_inputs(const GoldenSuite& suite, OutputPlan& plan) {
    std::error_code missing;
    if (!fs::is_directory(suite.references, missing)) return;
    add_compared_folder(suite.references, plan);
}

void add_references(const GoldenSuite& suite, std::span<const GoldenCase* const> cases,
                    const std::optional<std::string>& platform, OutputPlan& plan) {
    check_reference_folder(suite);
    const auto add = [&](const std::string& name) {
        plan.add_below("references", suite.references, reference_name(name, platform));
    };
    for (const GoldenCase* golden : cases) {
        for (const std::int64_t frame : golden->frames) add(golden->image_name(frame));
        add(golden->record_name());
    }
}

}  // namespace tumble
