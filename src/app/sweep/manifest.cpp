#include "app/sweep/manifest.h"

#include "output/output_path.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <utility>

namespace tumble {
namespace {

constexpr std::size_t flush_at = 1 << 16;  // bytes

}  // namespace

ManifestFile::ManifestFile(const std::filesystem::path& folder) : file_(confined_path(folder, path_in({}))) {}

void ManifestFile::write(std::string& line) {
    buffer_ += line;
    buffer_ += '\n';
    if (buffer_.size() >= flush_at) flush();
}

void ManifestFile::flush() {
    file_.write(buffer_);
    buffer_.clear();
}

void ManifestFile::add(std::int64_t index, std::string line) {
    waiting_[index] = std::move(line);
    while (!waiting_.empty() && waiting_.begin()->first <= next_) {
        write(waiting_.begin()->second);
        next_ = waiting_.begin()->first + 1;
        waiting_.erase(waiting_.begin());
    }
}

void ManifestFile::finish() {
    for (auto& [index, line] : waiting_) write(line);
    waiting_.clear();
    flush();
    file_.commit();
}

std::map<std::int64_t, std::string> read_sweep_manifest(const std::filesystem::path& folder) {
    std::map<std::int64_t, std::string> lines;
    std::ifstream file(ManifestFile::path_in(folder), std::ios::binary);
    for (std::string line; std::getline(file, line);) {
        const auto json = nlohmann::json::parse(line, nullptr, false);
        if (json.is_object() && json.contains("index") && json["index"].is_number_integer())
            lines[json["index"].get<std::int64_t>()] = line;
    }
    return lines;
}

}  // namespace tumble
