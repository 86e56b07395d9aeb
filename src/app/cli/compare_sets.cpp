#include "app/cli/compare_command.h"

#include "app/causes/explain.h"
#include "app/causes/motion_record.h"
#include "app/cli/render_run.h"
#include "app/cli/say.h"
#include "app/compare/accepted_pictures.h"
#include "app/compare/clip_pairs.h"
#include "app/compare/compared_frames.h"
#include "app/files/frame_folder.h"
#include "app/files/frame_set.h"
#include "app/files/output_plan.h"
#include "app/threads/interrupt.h"
#include "compare/comparison.h"
#include "compare/image_folder.h"
#include "compare/pair_compare.h"
#include "compare/platform.h"
#include "compare/report/comparison_report.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/output_path.h"
#include "output/picture_reader.h"
#include "output/temporary_file.h"
#include "output/temporary_folder.h"
#include "scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

std::optional<std::int64_t> frame_number(const std::string& name) { return number_in(name, "frame_", ".png"); }

/// The frames of the references that the scene has.
FrameSet frames_of(const NamedFiles& references, const SceneDescription& scene) {
    std::set<std::int64_t> numbers;  // a name may have more digits than its number needs
    for (const auto& [name, file] : references) numbers.insert(*frame_number(name));
    const std::int64_t count = scene.frame_count();
    FrameSet frames;
    for (const std::int64_t number : numbers)
        if (number < count) frames.append(number, number + 1);
    return frames;
}

/// The size of the first reference that can be read: a broken one is a result of the comparison. Throws InputError if
/// all are broken.
ImageSize size_of(const NamedFiles& references) {
    for (const auto& [name, file] : references) try {
            return read_picture_size(file);
        } catch (const InputError&) {
            if (file == references.rbegin()->second) throw;
        }
    return {};
}

enum class CompareInput { picture, folder, clip, scene };

constexpr std::string_view clip_endings[] = {".mp4", ".mov", ".mkv", ".webm", ".gif", ".avi", ".m4v"};

/// By its name, and by the file system for a folder. Throws InputError if a file or folder does not exist.
CompareInput compare_input(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (std::filesystem::is_directory(status)) return CompareInput::folder;
    if (!std::filesystem::exists(status)) throw InputError({path.string(), 0, 0}, "there is no such file or folder");
    const std::string ending = path.extension().string();
    if (ending == ".toml") return CompareInput::scene;
    const bool clip = std::find(std::begin(clip_endings), std::end(clip_endings), ending) != std::end(clip_endings);
    return clip ? CompareInput::clip : CompareInput::picture;
}

PairTolerances tolerances_of_options(const v0::CompareOptions& options) {
    PairTolerances tolerances;
    tolerances.pixels = {options.tolerance, options.fraction, options.cluster, options.window, options.shade};
    return tolerances;
}

/// The references that are frames (frame_000041.png), which a scene can be compared with. Throws InputError if there
/// are none.
NamedFiles frames_among(const NamedFiles& references, const std::filesystem::path& folder) {
    NamedFiles frames;
    for (const auto& [name, file] : references)
        if (frame_number(name)) frames[name] = file;
    if (frames.empty())
        throw InputError({folder.string(), 0, 0},
                         "the folder holds no frames of a scene (frame_000000.png, frame_000001.png, ...)");
    return frames;
}

/// Draws the frames with the numbers of the references into `to`, at the size of the first of them. Frames beyond the
/// end of the scene are left out.
void draw_frames_of(const CompareCommand& command, const std::filesystem::path& scene, const NamedFiles& references,
                    const std::filesystem::path& to) {
    const ImageSize size = size_of(references);
    const FrameSet frames = frames_of(references, load_scene(scene, command.overrides));
    if (frames.empty()) return;
    RenderCommand render;
    render.frames_range = frames.text(std::size_t(frames.count()));
    render.scenes = {scene};
    render.frames = to;
    render.overrides = command.overrides;
    render.overrides.width = size.width;
    render.overrides.height = size.height;
    render.workers = command.workers;
    render.quiet = command.quiet;
    render.motion_record = to / folder_record_name;
    render_to_files(render);
}

/// The comparison of a command: its operands in order, its settings, and the folder for frames that are drawn.
class SetComparisonRun {
public:
    explicit SetComparisonRun(const CompareCommand& command) : command_(command) {
        reference_ = command.a;
        image_ = command.b;
        // A scene is always the side under test.
        if (compare_input(reference_) == CompareInput::scene) std::swap(reference_, image_);
        of_reference_ = compare_input(reference_);
        of_image_ = compare_input(image_);
        check_kinds();
        const PairTolerances base = tolerances_of_options(command.options);
        tolerances_ = command.tolerances ? Tolerances::read(*command.tolerances, base) : Tolerances(base);
        if (of_reference_ == CompareInput::folder) {
            finish_left_transactions(reference_);
            references_ = pictures_in(reference_);
        }
        if (of_image_ == CompareInput::folder) images_ = pictures_in(image_);
        plan_outputs();
        if (command.accept) accept();
    }

    SetResult compare() {
        SetResult result;
        result.reference = reference_.string();
        result.image = image_.string();
        result.added_allowed = command_.allow_added;
        if (of_reference_ == CompareInput::clip || of_image_ == CompareInput::clip)
            result.images = compare_frames();
        else if (of_image_ == CompareInput::scene)
            result.images = compare_scene(result);
        else if (of_image_ == CompareInput::folder)
            result.images = compare_folders(result);
        else
            result.images = compare_pictures();
        return result;
    }

    /// Precondition: it is the result of compare(), whose frames are still there.
    void write_report(const SetResult& result) const {
        ReportOptions options;
        options.generator = "Tumble " TUMBLE_VERSION;
        options.platform = this_platform();
        if (command_.tolerances) options.tolerances = command_.tolerances->string();
        options.workers = command_.workers;
        write_comparison_report(result, options, *command_.report);
    }

    /// Gives accepted pictures their names. Postcondition: no result names a file that is gone after the run.
    void finish(SetResult& result) {
        if (accepted_) accepted_->commit();
        if (temporary_) forget_files_in(temporary_->path(), result);
    }

    const Tolerances& tolerances() const { return tolerances_; }

private:
    void check_kinds() const {
        const auto both = [&](CompareInput kind) { return of_reference_ == kind && of_image_ == kind; };
        const auto one = [&](CompareInput kind) { return of_reference_ == kind || of_image_ == kind; };
        if (both(CompareInput::picture) || both(CompareInput::folder) || both(CompareInput::clip)) return;
        if (one(CompareInput::folder) && !one(CompareInput::picture)) return;
        throw InputError(
            fmt::format("cannot compare '{}' with '{}': compare two pictures, two folders, two clips, or a "
                        "folder with a clip or a scene",
                        safe_path(command_.a), safe_path(command_.b)));
    }

    void plan_outputs() const {
        OutputPlan plan;
        add_inputs(reference_, of_reference_, plan);
        add_inputs(image_, of_image_, plan);
        plan.add_inputs(tolerances_.files());
        if (command_.json) plan.add("--json", *command_.json);
        if (command_.junit) plan.add("--junit", *command_.junit);
        if (command_.report) plan.add("--report", *command_.report);
        if (command_.difference) plan_differences(*command_.difference, plan);
    }

    void add_inputs(const fs::path& path, CompareInput kind, OutputPlan& plan) const {
        FileList read{path};
        if (kind == CompareInput::folder) return add_compared_folder(path, plan);
        if (kind == CompareInput::scene) load_scene(path, command_.overrides, &read);
        plan.add_inputs(read);
    }

    void plan_differences(const fs::path& difference, OutputPlan& plan) const {
        if (of_reference_ == CompareInput::picture) return plan.add("--diff", difference);
        if (fs::exists(difference) && !fs::is_directory(difference))
            throw InputError(
                fmt::format("--diff: must be a folder where more than two pictures are compared ('{}' is no folder)",
                            safe_path(difference)));
        for (const ImagePair& pair : pairs_of(references_.files, images_.files))
            plan.add_below("--diff", difference, difference_name(pair.name));
        if (of_reference_ != CompareInput::clip && of_image_ != CompareInput::clip) return;
        // The frames of a clip are not counted yet.
        const std::vector<std::int64_t> numbers =
            fs::exists(difference) ? frames_in(difference) : std::vector<std::int64_t>{0};
        for (const std::int64_t number : numbers) plan.add_below("--diff", difference, frame_path({}, number));
    }

    void accept() {
        if (of_reference_ == CompareInput::clip)
            throw InputError(fmt::format("--accept: the references are a clip, '{}': give a folder or a picture",
                                         safe_path(reference_)));
        const bool folder = of_reference_ == CompareInput::folder;
        const fs::path parent = reference_.has_parent_path() ? reference_.parent_path() : fs::path(".");
        std::optional<std::string> platform;
        if (folder && command_.platform && *command_.platform != "none") platform = command_.platform;
        accepted_.emplace(folder ? reference_ : parent, platform);
        // Before anything is written: also where the picture will turn out to be alike.
        if (!folder) confined_path(parent, reference_.filename(), InnerLinks::refused);
        for (const ImagePair& pair : pairs_of(references_.files, images_.files))
            confined_path(reference_, pair.name, InnerLinks::refused);
    }

    void write_difference_of(const ImagePair& pair) const {
        const CompareOptions options = tolerances_.of(pair.name).pixels;
        if (of_reference_ == CompareInput::picture) return write_difference(pair, options, *command_.difference);
        const fs::path file = confined_path(*command_.difference, difference_name(pair.name));
        make_folder(file.parent_path());
        write_difference(pair, options, file);
    }

    std::vector<ImageResult> compare(const PairSource& next) {
        Interrupt interrupt;
        return compare_pairs(
            [&]() -> std::optional<ImagePair> {
                if (interrupt.pending()) throw Interrupted();
                return next();
            },
            tolerances_, command_.workers,
            [&](const ImagePair& pair, ImageResult& result) {
                if (kept_) kept_->keep(pair, result);
                if (command_.difference && (result.verdict == Verdict::different || result.sizes_differ()))
                    write_difference_of(pair);
                if (accepted_) accepted_->take(pair, result);
            });
    }

    std::vector<ImageResult> compare_pictures() {
        const std::string name = reference_.filename().string();
        return compare_files({{name, reference_}}, {{name, image_}});
    }

    std::vector<ImageResult> compare_files(const NamedFiles& references, const NamedFiles& images) {
        const std::vector<ImagePair> pairs = pairs_of(references, images);
        std::size_t index = 0;
        return compare([&]() -> std::optional<ImagePair> {
            return index < pairs.size() ? std::optional(pairs[index++]) : std::nullopt;
        });
    }

    References references_for(const NamedFiles& images, SetResult& result) const {
        References references = references_of(references_.files, images, platform_of_option(command_.platform),
                                              platform_folders(tolerances_.platforms()));
        result.platform = references.platform;
        return references;
    }

    void say_other_pictures() const {
        std::vector<std::string> names = references_.other;
        names.insert(names.end(), images_.other.begin(), images_.other.end());
        if (!names.empty())
            say("note: {} pictures are not compared, because they are no PNG and no JPEG files: {}{}\n", names.size(),
                safe_text(names.front()), names.size() > 1 ? ", ..." : "");
    }

    std::vector<ImageResult> compare_folders(SetResult& result) {
        say_other_pictures();
        const References references = references_for(images_.files, result);
        if (references.files.empty() && images_.files.empty())
            throw InputError(fmt::format("there are no pictures (PNG, JPEG) in '{}' and '{}'", safe_path(reference_),
                                         safe_path(image_)));
        return compare_files(references.files, images_.files);
    }

    std::vector<ImageResult> compare_scene(SetResult& result) {
        const References references = references_for({}, result);
        const NamedFiles frames = frames_among(references.files, reference_);
        const std::size_t others = references.files.size() - frames.size() + references_.other.size();
        if (others > 0) say("note: {} files of the folder are no frames of a scene, and are not compared\n", others);
        temporary_.emplace("compare");
        draw_frames_of(command_, image_, frames, temporary_->path());
        NamedFiles images = pictures_in(temporary_->path()).files;
        std::erase_if(images, [&](const auto& image) { return frames.count(image.first) == 0; });
        return compare_files(frames, images);
    }

    std::vector<ImageResult> compare_frames() {
        FramePairs pairs(reference_, image_, command_.overrides.fps);
        if (command_.report) {
            temporary_.emplace("compare");
            kept_.emplace(temporary_->path());
        }
        return compare([&] { return pairs.next(); });
    }

    const CompareCommand& command_;
    fs::path reference_, image_;
    CompareInput of_reference_, of_image_;
    PictureFolder references_, images_;  // of folders
    Tolerances tolerances_;
    std::optional<AcceptedPictures> accepted_;
    std::optional<TemporaryFolder> temporary_;  // frames that a scene or a clip gave
    std::optional<KeptFrames> kept_;
};

}  // namespace

bool compares_sets(const CompareCommand& command) {
    if (command.tolerances || command.json || command.junit || command.report || command.accept) return true;
    return compare_input(command.a) != CompareInput::picture || compare_input(command.b) != CompareInput::picture;
}

int compare_sets(const CompareCommand& command) {
    SetComparisonRun run(command);
    SetResult result = run.compare();
    explain_frames(result);
    if (command.report) run.write_report(result);
    run.finish(result);
    if (command.json) write_file(*command.json, to_json(result));
    if (command.junit) write_file(*command.junit, to_junit(result));
    std::vector<std::string> names;
    for (const ImageResult& image : result.images) names.push_back(image.name);
    for (const std::string& rule : run.tolerances().unused(names))
        say("note: the rule stands for no picture: {}\n", rule);
    print_summary(result, command.quiet);
    return result.exit_code();
}

}  // namespace tumble
