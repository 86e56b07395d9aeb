// Drawn images of earlier runs, by what they depend on. A folder for each case and key:
//   CASE-0123456789abcdef/   CASE_000000.png, ..., CASE.motion.json
// Images are renamed into it when they are whole, so that several runs may share a cache: each run that draws the
// images of a key makes the same bytes.
#pragma once

#include "app/golden/suite.h"
#include "app/threads/interrupt.h"
#include "output/temporary_folder.h"

#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

class ImageCache {
public:
    /// The folder is made when an image is stored.
    explicit ImageCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The folder of a case. `key`: a hash of all that its images depend on.
    std::filesystem::path entry(const GoldenCase& golden, const std::string& key) const;

    /// True if all images of the case are in its entry.
    static bool holds(const GoldenCase& golden, const std::filesystem::path& entry);

    /// A new folder in the cache for the drawings of a run; those of killed runs are removed. Throws RunError.
    TemporaryFolder make_work_folder() const;

    /// Moves the drawn files of a folder into the entry, and removes entries of other keys of the case. Throws
    /// RunError.
    void store(const GoldenCase& golden, const std::filesystem::path& drawn, const std::filesystem::path& entry) const;

private:
    void remove_older(const GoldenCase& golden, const std::filesystem::path& entry) const;

    std::filesystem::path folder_;
};

/// The folder NAME-HASH of the suite in `base`. Without it: in tumble/golden of $XDG_CACHE_HOME or of ~/.cache, or of
/// the temporary folder without a home.
std::filesystem::path cache_folder(const GoldenSuite& suite, const std::optional<std::filesystem::path>& base);

// -- The causes of pixels apart from the scene: program, shaders, libraries that draw, fonts, processor.

/// A text that is the same as long as all of these are. Libraries are loaded in a process of their own. Precondition:
/// the program has no other thread.
std::string program_identity(Interrupt& interrupt);

}  // namespace tumble
