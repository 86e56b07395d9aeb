// Folders of PNG files, and pairs of them by their relative names.
#pragma once

#include "compare/pair_compare.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble {

/// Files by their name, a path in the folder with '/'.
using NamedFiles = std::map<std::string, std::filesystem::path>;

/// The PNG files (.png, .PNG) of a folder and the folders in it. Links to files are followed, links to folders are not;
/// names that begin with '.' are left out. Throws InputError if it is no folder or cannot be read.
NamedFiles png_files_in(const std::filesystem::path& folder);

struct References {
    NamedFiles files;
    std::string platform;  // whose files replace general ones; empty: none
};

/// The references of a platform: each file NAME, or PLATFORM/NAME where that exists. Folders of the other platforms in
/// `all_platforms` are left out. A folder that `images` has too is no platform's.
References references_of(const NamedFiles& files, const NamedFiles& images, const std::string& platform,
                         const std::vector<std::string>& all_platforms);

/// All names of both, in their order.
std::vector<ImagePair> pairs_of(const NamedFiles& references, const NamedFiles& images);

}  // namespace tumble
