// The manifest of a sweep: a line of JSON for each sample, in the order of their indices.
#pragma once

#include "output/temporary_file.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace tumble {

/// Lines are given in any order. Those whose predecessors are there are written to the unfinished file, so that memory
/// does not grow with the number of samples.
class ManifestFile {
public:
    /// All members throw RunError.
    explicit ManifestFile(const std::filesystem::path& folder);

    void add(std::int64_t index, std::string line);

    /// Writes the lines that still wait for a predecessor as well, and gives the file its name.
    void finish();

    static std::filesystem::path path_in(const std::filesystem::path& folder) { return folder / "manifest.jsonl"; }

private:
    void write(std::string& line);
    void flush();

    TemporaryFile file_;
    std::string buffer_;
    std::map<std::int64_t, std::string> waiting_;
    std::int64_t next_ = 0;
};

/// The lines of an older manifest by index; none if there is no such file. Lines that are no JSON are left out.
std::map<std::int64_t, std::string> read_sweep_manifest(const std::filesystem::path& folder);

}  // namespace tumble
