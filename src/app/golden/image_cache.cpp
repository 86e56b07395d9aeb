#include "app/golden/image_cache.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "core/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr const char* work_prefix = ".work-";  // of folders of drawings
constexpr std::size_t key_digits = 16;         // hexadecimal: of a hash, enough to tell the versions of a case apart

void make_folders(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw RunError(fmt::format("cannot make the folder of the cache '{}': {} (--cache names another one)",
                                   safe_path(folder), error.message()));
}

/// True for "NAME-" and a key, which a case with a longer name has not.
bool is_entry_of(const std::string& name, const std::string& file) {
    if (file.size() != name.size() + 1 + key_digits || !file.starts_with(name + "-")) return false;
    return file.find_first_not_of("0123456789abcdef", name.size() + 1) == std::string::npos;
}

fs::path default_base() {
    const auto variable = [](const char* name) { return std::getenv(name) ? fs::path(std::getenv(name)) : fs::path(); };
    fs::path base = variable("XDG_CACHE_HOME");
    if (base.empty() && !variable("HOME").empty()) base = variable("HOME") / ".cache";
    if (base.empty()) base = fs::temp_directory_path();
    return base / "tumble" / "golden";
}

}  // namespace

fs::path ImageCache::entry(const GoldenCase& golden, const std::string& key) const {
    return folder_ / fmt::format("{}-{}", golden.name, key.substr(0, key_digits));
}

bool ImageCache::holds(const GoldenCase& golden, const fs::path& entry) {
    std::error_code ignored;
    return std::ranges::all_of(golden.frames, [&](std::int64_t frame) {
        return fs::is_regular_file(entry / golden.image_name(frame), ignored);
    });
}

TemporaryFolder ImageCache::make_work_folder() const {
    make_folders(folder_);
    remove_left_folders(folder_, work_prefix);
    return {folder_, work_prefix};
}

void ImageCache::store(const GoldenCase& golden, const fs::path& drawn, const fs::path& entry) const {
    make_folders(entry);
    std::error_code error;
    for (const fs::directory_entry& file : fs::directory_iterator(drawn)) {
        fs::rename(file.path(), entry / file.path().filename(), error);
        if (error) throw RunError(fmt::format("cannot move an image to '{}': {}", safe_path(entry), error.message()));
    }
    remove_older(golden, entry);
}

void ImageCache::remove_older(const GoldenCase& golden, const fs::path& entry) const {
    std::error_code error;
    std::vector<fs::path> older;
    for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error))
        if (is_entry_of(golden.name, it->path().filename().string()) && it->path() != entry)
            older.push_back(it->path());
    for (const fs::path& folder : older) fs::remove_all(folder, error);
}

fs::path cache_folder(const GoldenSuite& suite, const std::optional<fs::path>& base) {
    const fs::path file = fs::weakly_canonical(suite.file);
    return base.value_or(default_base()) /
           fmt::format("{}-{}", file.stem().string(), sha256(file.string()).substr(0, key_digits));
}

}  // namespace tumble
