#include "compare/image_folder.h"

#include "core/error.h"

#include <set>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

bool is_png_name(const fs::path& path) {
    const std::string end = path.extension().string();
    return end == ".png" || end == ".PNG";
}

/// "amd" of "amd/a.png"; empty without a folder.
std::string first_folder(const std::string& name) {
    const std::size_t slash = name.find('/');
    return slash == std::string::npos ? std::string() : name.substr(0, slash);
}

}  // namespace

NamedFiles png_files_in(const fs::path& folder) {
    std::error_code error;
    NamedFiles files;
    const auto check = [&](const fs::path& where) {
        if (error) throw InputError({where.string(), 0, 0}, "cannot read the folder: " + error.message());
    };
    fs::recursive_directory_iterator entry(folder, error), end;
    check(folder);
    while (entry != end) {
        const fs::path path = entry->path();
        if (path.filename().string().front() == '.') {
            entry.disable_recursion_pending();
        } else if (is_png_name(path) && !entry->is_directory(error)) {
            files[path.lexically_relative(folder).generic_string()] = path;
        }
        entry.increment(error);
        check(path);
    }
    return files;
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
