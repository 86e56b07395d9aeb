#include "app/sweep/sample_folder.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr const char* number_field = "{:06}";

[[noreturn]] void fail(const fs::path& path, int error) {
    throw RunError(fmt::format("cannot write '{}': {}", safe_path(path), std::generic_category().message(error)));
}

/// The file is not brought to the disk: its folder gets its name later, and its record has the number of bytes.
void write_whole(const fs::path& path, std::span<const std::byte> bytes) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) fail(path, errno);
    while (!bytes.empty()) {
        const ssize_t n = ::write(file, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            const int error = errno;
            ::close(file);
            fail(path, error);
        }
        bytes = bytes.subspan(std::size_t(n));
    }
    if (::close(file) != 0 && errno != EINTR) fail(path, errno);
}

/// Adds the content of a file to a checksum. False: it cannot be read.
bool add_content(const fs::path& path, std::uint64_t& bytes, std::uint32_t& checksum) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return false;
    char block[1 << 16];
    while (file.read(block, sizeof block), file.gcount() > 0) {
        const auto n = std::size_t(file.gcount());
        bytes += n;
        checksum = crc32_of(checksum, std::as_bytes(std::span(block, n)));
    }
    return !file.bad();
}

}  // namespace

std::string SampleFile::path_of(std::int64_t number) const {
    const std::size_t at = path.find(number_field);
    if (at == std::string::npos) return path;
    std::string name = path;
    return name.replace(at, std::string(number_field).size(), fmt::format("{:06}", number));
}

SampleFolder::SampleFolder(fs::path part) : part_(std::move(part)) {
    std::error_code error;
    fs::remove_all(part_, error);
    fs::create_directories(part_, error);
    if (error) fail(part_, error.value());
}

SampleFolder::~SampleFolder() {
    std::error_code ignored;
    if (!published_) fs::remove_all(part_, ignored);
}

void SampleFolder::add_folder(const std::string& name) const {
    std::error_code error;
    fs::create_directory(part_ / name, error);
    if (error) fail(part_ / name, error.value());
}

void SampleFolder::write(const std::string& name, std::span<const std::byte> bytes) {
    write_whole(part_ / name, bytes);
    files_.push_back({name, std::nullopt, 1, bytes.size(), crc32_of(0, bytes)});
}

void SampleFolder::write(const std::string& pattern, std::int64_t number, std::span<const std::byte> bytes) {
    SampleFile* series = nullptr;
    for (SampleFile& file : files_)
        if (file.path == pattern) series = &file;
    if (series == nullptr) series = &files_.emplace_back(SampleFile{pattern, number, 0, 0, 0});
    write_whole(part_ / series->path_of(number), bytes);
    ++series->count;
    series->bytes += bytes.size();
    series->checksum = crc32_of(series->checksum, bytes);
}

void SampleFolder::add(const std::string& name) {
    SampleFile file{name, std::nullopt, 1, 0, 0};
    if (!add_content(part_ / name, file.bytes, file.checksum))
        throw RunError(fmt::format("cannot read '{}' again", safe_path(part_ / name)));
    files_.push_back(std::move(file));
}

void SampleFolder::publish(const fs::path& final_path) {
    std::error_code error;
    fs::create_directories(final_path.parent_path(), error);
    if (error) fail(final_path.parent_path(), error.value());
    if (::rename(part_.c_str(), final_path.c_str()) != 0) {
        if (errno != EEXIST && errno != ENOTEMPTY && errno != ENOTDIR) fail(final_path, errno);
        if (!fs::exists(final_path / record_name, error))
            throw RunError(fmt::format("'{}' exists and is no sample ({} is missing): move it, or name another folder",
                                       safe_path(final_path), record_name));
        // An older folder: the two change places, so that at each moment one of them is there.
        if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, final_path.c_str(), RENAME_EXCHANGE) == 0) {
            fs::remove_all(part_, error);
        } else {
            fs::remove_all(final_path, error);
            if (::rename(part_.c_str(), final_path.c_str()) != 0) fail(final_path, errno);
        }
    }
    published_ = true;
}

bool files_are_whole(const fs::path& folder, const std::vector<SampleFile>& files) {
    for (const SampleFile& file : files) {
        std::uint64_t bytes = 0;
        for (std::int64_t i = 0; i < file.count; ++i) {
            struct stat status {};
            if (::stat((folder / file.path_of(file.first.value_or(0) + i)).c_str(), &status) != 0) return false;
            bytes += std::uint64_t(status.st_size);
        }
        if (bytes != file.bytes) return false;
    }
    return true;
}

}  // namespace tumble
