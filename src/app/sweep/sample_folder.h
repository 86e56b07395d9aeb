// The folder of a sample while it is made: under a hidden name, until all of its files are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// The record of a sample, which makes a folder one.
inline constexpr const char* record_name = "sample.json";

/// A file of a sample, or the files of its frames, in order, as one.
struct SampleFile {
    std::string path;                   // relative to the sample; of a series with "{:06}" for the number
    std::optional<std::int64_t> first;  // number of a series
    std::int64_t count = 1;
    std::uint64_t bytes = 0;     // of all
    std::uint32_t checksum = 0;  // CRC-32 of their bytes one after the other

    std::string path_of(std::int64_t number) const;
};

class SampleFolder {
public:
    /// An empty folder `part`, which replaces an older one. Throws RunError.
    explicit SampleFolder(std::filesystem::path part);
    /// Removes the folder, unless it was published.
    ~SampleFolder();
    SampleFolder(const SampleFolder&) = delete;
    SampleFolder& operator=(const SampleFolder&) = delete;

    const std::filesystem::path& path() const { return part_; }
    /// Makes a folder in it.
    void add_folder(const std::string& name) const;

    void write(const std::string& name, std::span<const std::byte> bytes);
    void write(const std::string& name, const std::string& text) { write(name, std::as_bytes(std::span(text))); }
    /// The next file of a series; `pattern`: its path with "{:06}".
    void write(const std::string& pattern, std::int64_t number, std::span<const std::byte> bytes);
    /// A file that was written by other means.
    void add(const std::string& name);

    const std::vector<SampleFile>& files() const { return files_; }

    /// Gives it its final name, instead of an older sample. Throws RunError, also where another folder has that name.
    void publish(const std::filesystem::path& final_path);

private:
    std::filesystem::path part_;
    bool published_ = false;
    std::vector<SampleFile> files_;
};

/// True if the files are in the folder with their number of bytes.
bool files_are_whole(const std::filesystem::path& folder, const std::vector<SampleFile>& files);

}  // namespace tumble
