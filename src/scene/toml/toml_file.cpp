#include "scene/toml/toml_file.h"

#include "core/input_file.h"

namespace tumble {

std::string read_toml_file(const std::filesystem::path& file, const std::string& what, std::int64_t most_bytes) {
    return read_input_file(file, "the " + what, most_bytes);
}

}  // namespace tumble
