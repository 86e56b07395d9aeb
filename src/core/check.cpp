#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace tumble {

void contract_broken(const char* file, int line, const std::string& text) {
    // The only print outside app/: the process aborts next, so no caller can report the reason.
    std::fprintf(stderr, "%s:%d: broken contract: %s\n", file, line, text.c_str());
    std::abort();
}

}  // namespace tumble
