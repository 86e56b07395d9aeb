#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace tumble {

void contract_broken(const char* file, int line, const std::string& text) {
    // The one print outside app/: the process is about to abort and nobody else can say why.
    std::fprintf(stderr, "%s:%d: broken contract: %s\n", file, line, text.c_str());
    std::abort();
}

}  // namespace tumble
