#include "output/confined_path.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/output_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& problem) {
    throw InputError(fmt::format("cannot write '{}': {}", safe_path(path), problem));
}

bool lies_in(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

class Confinement {
public:
    Confinement(const fs::path& folder, InnerLinks links) : folder_(folder), links_(links) {
        std::error_code missing;
        real_ = fs::canonical(folder, missing);
    }

    /// A folder on the way to the output; one that is missing will be made.
    void check_folder(const fs::path& path) const {
        std::error_code error;
        if (fs::is_symlink(fs::symlink_status(path, error))) check_link(path, fs::canonical(path, error));
    }

    void check_file(const fs::path& path) const {
        std::error_code error;
        if (fs::is_symlink(fs::symlink_status(path, error))) {
            const fs::path target = output_target(path).path;
            const fs::path parent = target.has_parent_path() ? target.parent_path() : fs::path(".");
            const fs::path real = fs::canonical(parent, error);
            check_link(path, error ? fs::path() : real / target.filename());
        }
        const fs::file_status status = fs::status(path, error);
        if (fs::exists(status) && !fs::is_regular_file(status)) refuse(path, "it is no regular file");
    }

private:
    /// `real`: the place that it leads to; empty: nowhere.
    void check_link(const fs::path& path, const fs::path& real) const {
        if (links_ == InnerLinks::refused) refuse(path, "it is a link");
        if (real.empty() || real_.empty() || !lies_in(real, real_))
            refuse(path, fmt::format("it is a link that leads out of '{}'", safe_path(folder_)));
    }

    fs::path folder_, real_;
    InnerLinks links_;
};

}  // namespace

fs::path confined_path(const fs::path& folder, const fs::path& name, InnerLinks links) {
    if (name.empty() || name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end())
        refuse(folder / name, fmt::format("it is not below '{}'", safe_path(folder)));
    const Confinement confinement(folder, links);
    fs::path path = folder;
    for (auto part = name.begin(); part != name.end(); ++part) {
        path /= *part;
        if (std::next(part) == name.end())
            confinement.check_file(path);
        else
            confinement.check_folder(path);
    }
    return path;
}

}  // namespace tumble
