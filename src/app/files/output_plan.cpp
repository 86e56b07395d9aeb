#include "app/files/output_plan.h"

#include "app/files/frame_folder.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/output_path.h"

#include <fmt/format.h>

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

fs::path place_below(const std::string& option, const fs::path& folder, const fs::path& name, InnerLinks links) {
    try {
        return confined_path(folder, name, links);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", option, error.message()));
    }
}

/// Linux's null device: it may be the target of several outputs.
bool swallows_all(const struct stat& status) { return S_ISCHR(status.st_mode) && status.st_rdev == makedev(1, 3); }

}  // namespace

std::optional<OutputPlan::File> OutputPlan::file_at(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || swallows_all(status)) return std::nullopt;
    return File{status.st_dev, status.st_ino};
}

std::optional<OutputPlan::Place> OutputPlan::place_of(const fs::path& path) {
    fs::path rest = path.filename();
    for (fs::path folder = folder_of(path);; folder = folder_of(folder)) {
        if (const auto there = file_at(folder)) return Place{*there, rest};
        if (folder == folder_of(folder)) return std::nullopt;
        rest = folder.filename() / rest;
    }
}

bool OutputPlan::is_one_of(const Place& place, const OutputSeries& series) {
    const auto any = place_of(series.path(series.folder, series.first));
    if (!any || any->folder != place.folder) return false;
    if (place.rest == any->rest.parent_path()) return true;  // the folder itself, before it is made
    if (place.rest.parent_path() != any->rest.parent_path()) return false;
    const std::string name = place.rest.filename().string();
    const auto number = number_in(name, series.before, series.after);
    return number && *number >= series.first && *number < series.end &&
           series.path(series.folder, *number).filename() == name;
}

OutputPlan::Output OutputPlan::look_at(const std::string& option, const fs::path& name) {
    const OutputTarget target = output_target(name);
    Output output{option, name, target.path, std::nullopt, std::nullopt};
    if (target.descriptor) {
        struct stat status {};
        // A file that is opened later might get this number.
        if (::fstat(*target.descriptor, &status) != 0)
            throw RunError(
                fmt::format("cannot write '{}': {}", safe_path(name), std::generic_category().message(errno)));
        if (!swallows_all(status)) output.file = File{status.st_dev, status.st_ino};
        return output;
    }
    output.file = file_at(target.path);
    if (!target.in_place) output.place = place_of(target.path);
    return output;
}

void OutputPlan::compare_with_inputs(const Output& output) const {
    if (!output.file) return;
    if (const auto input = inputs_.find(*output.file); input != inputs_.end())
        throw InputError(fmt::format("{}: '{}' would replace '{}', which is read", output.option,
                                     safe_path(output.name), safe_path(input->second)));
}

void OutputPlan::compare_with_input_folders(const Output& output) const {
    if (folders_.empty() || !output.place) return;
    // From the output upwards, by the folders that its name leads to.
    std::error_code error;
    fs::path rest = output.target.filename(), above = folder_of(output.target);
    while (!fs::exists(above, error) && above != folder_of(above)) {
        rest = above.filename() / rest;
        above = folder_of(above);
    }
    for (above = fs::canonical(above, error); !error; above = above.parent_path()) {
        const std::optional<File> there = file_at(above);
        for (const InputFolder& folder : folders_)
            if (there == folder.file && folder.reads(rest))
                throw InputError(
                    fmt::format("{}: '{}' would be one of the files in '{}' that are read; name a place "
                                "elsewhere",
                                output.option, safe_path(output.name), safe_path(folder.name)));
        if (above == above.parent_path()) return;
        rest = above.filename() / rest;
    }
}

void OutputPlan::compare_with_outputs(const Output& output) const {
    const auto fail = [&](const std::string& option, const fs::path& name) {
        throw InputError(fmt::format("{} and {} must be two files ('{}' and '{}' are one)", option, output.option,
                                     safe_path(name), safe_path(output.name)));
    };
    const auto compare = [&](const auto& known, const auto& key) {
        if (!key) return;
        if (const auto other = known.find(*key); other != known.end())
            fail(outputs_[other->second].option, outputs_[other->second].name);
    };
    compare(by_place_, output.place);
    compare(by_file_, output.file);
    for (const OutputSeries& series : series_)
        if (output.place && is_one_of(*output.place, series)) fail(series.option, series.folder);
}

void OutputPlan::keep(const Output& output) {
    if (output.place) by_place_.try_emplace(*output.place, outputs_.size());
    if (output.file) by_file_.try_emplace(*output.file, outputs_.size());
    outputs_.push_back(output);
}

void OutputPlan::add_input(const fs::path& file) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return;
    if (const auto there = file_at(file)) inputs_.try_emplace(*there, file);
}

void OutputPlan::add_inputs(const std::vector<fs::path>& files) {
    for (const fs::path& file : files) add_input(file);
}

void OutputPlan::add_input_folder(const fs::path& folder, std::function<bool(const fs::path&)> reads) {
    if (const auto there = file_at(folder)) folders_.push_back({folder, *there, std::move(reads)});
}

void OutputPlan::add(const std::string& option, const fs::path& file) {
    const Output output = look_at(option, file);
    compare_with_inputs(output);
    compare_with_input_folders(output);
    compare_with_outputs(output);
    keep(output);
}

void OutputPlan::add_below(const std::string& option, const fs::path& folder, const fs::path& name, InnerLinks links) {
    Output output = look_at(option, place_below(option, folder, name, links));
    compare_with_inputs(output);
    compare_with_input_folders(output);
    // Two names of one file in a folder are harmless: each is replaced by itself.
    std::error_code error;
    if (fs::is_regular_file(fs::symlink_status(output.name, error))) output.file.reset();
    compare_with_outputs(output);
    keep(output);
}

void OutputPlan::add_replaced_folders(const std::string& option, const fs::path& folder,
                                      const std::function<bool(const fs::path&)>& replaced) const {
    std::error_code error;
    const fs::path root = fs::canonical(folder, error);
    if (error) return;  // nothing is there yet
    for (const auto& [file, name] : inputs_) {
        const fs::path real = fs::canonical(name, error);
        for (fs::path above = real.parent_path(); !error && above != root && above != above.parent_path();
             above = above.parent_path())
            if (std::mismatch(root.begin(), root.end(), above.begin(), above.end()).first == root.end() &&
                replaced(above))
                throw InputError(
                    fmt::format("{}: '{}' would be replaced with all of '{}', and it is read; copy it out "
                                "of the folder first",
                                option, safe_path(name), safe_path(above)));
    }
}

void OutputPlan::add(const OutputSeries& series) {
    series_.push_back(series);
    compare_with_input_folders(look_at(series.option, series.path(series.folder, series.first)));
    for (const Output& output : outputs_)
        if (output.place && is_one_of(*output.place, series))
            throw InputError(fmt::format("{} and {} must be two files ('{}' is a name in '{}')", output.option,
                                         series.option, safe_path(output.name), safe_path(series.folder)));
    std::error_code error;
    if (!fs::is_directory(series.folder, error)) return;
    for (const std::int64_t number : numbers_in(series.folder, series.before, series.after)) {
        const fs::path name = series.path(series.folder, number);
        const fs::file_status status = fs::symlink_status(name, error);
        if (number < series.first || number >= series.end || !fs::exists(status)) continue;
        Output output = look_at(series.option, name);
        compare_with_inputs(output);
        // Two names of one file in a folder are harmless: each is replaced by itself.
        if (fs::is_regular_file(status)) output.place.reset();
        compare_with_outputs(output);
        if (fs::is_symlink(status)) {
            compare_with_input_folders(output);
            keep(output);
        }
    }
}

}  // namespace tumble
