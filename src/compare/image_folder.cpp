#include "compare/image_folder.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string_view>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> read_endings{".png", ".jpg", ".jpeg"};
constexpr std::array<std::string_view, 10> other_endings{".gif", ".bmp",  ".tga",  ".tif", ".tiff",
                                                         ".ppm", ".webp", ".avif", ".jxl", ".exr"};

bool has_ending(const fs::path& path, std::span<const std::string_view> endings) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    return std::ranges::find(endings, ending) != endings.end();
}

/// "amd" of "amd/a.png"; empty without a folder.
std::string first_folder(const std::string& name) {
    const std::size_t slash = name.find('/');
    return slash == std::string::npos ? std::string() : name.substr(0, slash);
}

}  // namespace

bool is_picture_name(const fs::path& path) { return has_ending(path, read_endings); }

bool is_hidden(const fs::path& name) {
    return std::ranges::any_of(name, [](const fs::path& part) { return part.native().starts_with('.'); });
}

std::vector<fs::path> files_in_folder(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> files;
    const auto check = [&](const fs::path& where) {
        if (error) throw InputError({where.string(), 0, 0}, "cannot read the folder: " + error.message());
    };
    fs::recursive_directory_iterator entry(folder, error), end;
    check(folder);
    while (entry != end) {
        const fs::path path = entry->path();
        if (path.filename().string().front() == '.') {
            entry.disable_recursion_pending();
        } else if (!entry->is_directory(error)) {
            files.push_back(path);
        }
        entry.increment(error);
        check(path);
    }
    return files;
}

PictureFolder pictures_in(const fs::path& folder) {
    PictureFolder pictures;
    for (const fs::path& file : files_in_folder(folder)) {
        const std::string name = file.lexically_relative(folder).generic_string();
        if (is_picture_name(file)) pictures.files[name] = file;
        if (has_ending(file, other_endings)) pictures.other.push_back(name);
    }
    std::ranges::sort(pictures.other);
    return pictures;
}

References references_of(const NamedFiles& files, const NamedFiles& images, const std::string& platform,
                         const std::vector<std::string>& all_platforms) {
    std::set<std::string> platforms(all_platforms.begin(), all_platforms.end());
    if (!platform.empty()) platforms.insert(platform);
    for (const auto& [name, file] : images) platforms.erase(first_folder(name));
    References references;
    for (const auto& [name, file] : files)
        if (platforms.count(first_folder(name)) == 0) references.files[name] = file;
    if (platform.empty() || platforms.count(platform) == 0) return references;
    for (const auto& [name, file] : files) {
        if (first_folder(name) != platform) continue;
        references.files[name.substr(platform.size() + 1)] = file;
        references.platform = platform;
    }
    return references;
}

std::vector<ImagePair> pairs_of(const NamedFiles& references, const NamedFiles& images) {
    std::set<std::string> names;
    for (const auto& [name, file] : references) names.insert(name);
    for (const auto& [name, file] : images) names.insert(name);
    std::vector<ImagePair> pairs;
    for (const std::string& name : names) {
        ImagePair pair{name, std::nullopt, std::nullopt};
        if (const auto found = references.find(name); found != references.end())
            pair.reference = ComparedPicture{found->second, nullptr};
        if (const auto found = images.find(name); found != images.end())
            pair.image = ComparedPicture{found->second, nullptr};
        pairs.push_back(std::move(pair));
    }
    return pairs;
}

}  // namespace tumble
