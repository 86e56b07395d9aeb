#include "app/output_path.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <system_error>

namespace tumble {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code missing;
    return fs::is_regular_file(a, missing) && fs::equivalent(a, b, missing);
}

void check_output(const char* option, const fs::path& output, const fs::path& input) {
    if (same_file(output, input))
        throw InputError(fmt::format("{}: '{}' would replace '{}', which is read", option, safe_path(output), safe_path(input)));
}

}  // namespace tumble
