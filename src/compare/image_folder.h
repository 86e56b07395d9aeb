// Folders of pictures, and pairs of them by their relative names.
#pragma once

#include "compare/pair_compare.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble {

/// Files by their name, a path in the folder with '/'.
using NamedFiles = std::map<std::string, std::filesystem::path>;

/// True for the endings of pictures that are compared: .png, .jpg and .jpeg, in any case.
bool is_picture_name(const std::filesystem::path& path);
/// True if a part of a relative name begins with '.': it is left out.
bool is_hidden(const std::filesystem::path& name);

/// All files of a folder and the folders in it. Links to files are followed, links to folders are not; names that begin
/// with '.' are left out. Throws InputError if it is no folder or cannot be read.
std::vector<std::filesystem::path> files_in_folder(const std::filesystem::path& folder);

struct PictureFolder {
    NamedFiles files;
    std::vector<std::string> other;  // names of pictures of kinds that are not compared
};

/// The pictures among the same files.
PictureFolder pictures_in(const std::filesystem::path& folder);

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
