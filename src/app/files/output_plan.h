// Inputs and outputs of a run, compared before anything is written. No output may be an input, and no two outputs may
// be one file, for any spelling of their names and through any links.
#pragma once

#include "output/output_path.h"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Frames or AOVs: one file per number.
struct OutputSeries {
    std::string option;
    std::filesystem::path folder;
    std::string_view before, after;  // parts of a name around the number
    std::filesystem::path (*path)(const std::filesystem::path& folder, std::int64_t);  // the file of a number
    std::int64_t first = 0, end = 0;                                                   // range of the numbers
};

/// All members throw InputError. Outputs may be added in any order, after all inputs.
class OutputPlan {
public:
    /// Devices and pipes are ignored.
    void add_input(const std::filesystem::path& file);
    void add_inputs(const std::vector<std::filesystem::path>& files);
    /// A folder of which files with some names (relative to it) are read, also those that the next run finds.
    void add_input_folder(const std::filesystem::path& folder, std::function<bool(const std::filesystem::path&)> reads);

    void add(const std::string& option, const std::filesystem::path& file);
    void add(const OutputSeries& series);
    /// An output that must stay below a folder (output_path.h).
    void add_below(const std::string& option, const std::filesystem::path& folder, const std::filesystem::path& name,
                   InnerLinks links = InnerLinks::followed);
    /// Folders below `folder` that are replaced as a whole, with all that they hold.
    void add_replaced_folders(const std::string& option, const std::filesystem::path& folder,
                              const std::function<bool(const std::filesystem::path&)>& replaced) const;

private:
    /// An existing file.
    struct File {
        dev_t device;
        ino_t number;
        friend auto operator<=>(const File&, const File&) = default;
    };
    /// A name that may not exist: its nearest existing folder, and the remaining path.
    struct Place {
        File folder;
        std::filesystem::path rest;
        friend bool operator==(const Place&, const Place&) = default;
        friend bool operator<(const Place& a, const Place& b) {
            return a.folder != b.folder ? a.folder < b.folder : a.rest < b.rest;
        }
    };
    struct InputFolder {
        std::filesystem::path name;
        File file;
        std::function<bool(const std::filesystem::path&)> reads;
    };
    struct Output {
        std::string option;
        std::filesystem::path name, target;
        std::optional<Place> place;  // of the name that will be replaced or made; none: written in place
        std::optional<File> file;    // the existing file
    };

    static std::optional<File> file_at(const std::filesystem::path& path);
    static std::optional<Place> place_of(const std::filesystem::path& path);
    static bool is_one_of(const Place& place, const OutputSeries& series);
    static Output look_at(const std::string& option, const std::filesystem::path& name);
    void compare_with_inputs(const Output& output) const;
    void compare_with_input_folders(const Output& output) const;
    void compare_with_outputs(const Output& output) const;
    void keep(const Output& output);

    std::map<File, std::filesystem::path> inputs_;
    std::vector<InputFolder> folders_;
    std::vector<Output> outputs_;  // single files, and links among those of a series
    std::map<Place, std::size_t> by_place_;
    std::map<File, std::size_t> by_file_;
    std::vector<OutputSeries> series_;
};

}  // namespace tumble
