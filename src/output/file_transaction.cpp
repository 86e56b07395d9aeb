#include "output/file_transaction.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "output/output_path.h"
#include "output/temporary_file.h"

#include <fmt/format.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <set>
#include <string>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr const char* staged_prefix = ".tumble.new-";
constexpr const char* journal_name = "journal";
constexpr std::string_view journal_head = "tumble-journal 1\n";

[[noreturn]] void fail(const fs::path& path, int error) {
    throw RunError(fmt::format("cannot write '{}': {}", safe_path(path), std::generic_category().message(error)));
}

fs::path staged_file(const fs::path& staged, std::size_t index) { return staged / std::to_string(index); }

/// Each name ends with a zero byte, because names may hold line breaks. The end of the list is marked.
std::string journal_text(const std::vector<fs::path>& names) {
    std::string text(journal_head);
    for (const fs::path& name : names) text += name.string() + '\0';
    return text + '\0';
}

/// Nothing for a file that is no whole journal.
std::optional<std::vector<fs::path>> names_in(const fs::path& journal) {
    const std::optional<std::string> bytes = bytes_of_file(journal);
    if (!bytes || !bytes->starts_with(journal_head)) return std::nullopt;
    std::vector<fs::path> names;
    for (std::size_t at = journal_head.size();;) {
        const std::size_t end = bytes->find('\0', at);
        if (end == std::string::npos) return std::nullopt;
        if (end == at) return names;
        names.emplace_back(bytes->substr(at, end - at));
        at = end + 1;
    }
}

/// Renames the files that have not got their names yet. The names may come with a foreign folder: they stay below it.
void rename_all(const fs::path& folder, const fs::path& staged, const std::vector<fs::path>& names) {
    std::set<fs::path> folders;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const fs::path from = staged_file(staged, i);
        std::error_code missing;
        if (!fs::is_regular_file(fs::symlink_status(from, missing))) continue;
        const fs::path to = confined_path(folder, names[i], InnerLinks::refused);
        if (::rename(from.c_str(), to.c_str()) != 0) fail(to, errno);
        folders.insert(to.parent_path());
    }
    for (const fs::path& changed : folders) bring_to_disk(changed);
}

}  // namespace

void finish_left_transactions(const fs::path& folder) {
    for (const LeftFolder& staged : left_folders(folder, staged_prefix)) {
        if (const auto names = names_in(staged.path / journal_name)) rename_all(folder, staged.path, *names);
        std::error_code ignored;
        fs::remove_all(staged.path, ignored);
    }
}

void FileTransaction::begin() {
    make_folder(folder_);
    finish_left_transactions(folder_);
    folder_ = fs::canonical(folder_);
    staged_.emplace(folder_, staged_prefix);
}

void FileTransaction::add(const fs::path& name, std::string_view bytes) {
    confined_path(folder_, name, links_);
    if (!staged_) begin();
    const fs::path target = output_target(confined_path(folder_, name, links_)).path;
    make_folder(target.parent_path());
    const fs::path parent = fs::canonical(target.parent_path());
    struct stat here {
    }, there{};
    if (::access(parent.c_str(), W_OK) != 0 || ::stat(parent.c_str(), &there) != 0) fail(target, errno);
    if (::stat(folder_.c_str(), &here) != 0) fail(folder_, errno);
    if (here.st_dev != there.st_dev) fail(target, EXDEV);  // before any file is renamed
    write_file(staged_file(staged_->path(), names_.size()), bytes);
    names_.push_back((parent / target.filename()).lexically_relative(folder_));
}

void FileTransaction::commit() {
    if (!staged_) return;
    write_file(staged_->path() / journal_name, journal_text(names_));
    staged_->keep();  // for the next run, if this one ends early
    rename_all(folder_, staged_->path(), names_);
    staged_->remove();
}

}  // namespace tumble
