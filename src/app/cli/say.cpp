#include "app/cli/say.h"

#include "core/error.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace tumble {
namespace {

[[noreturn]] void fail(int error) {
    throw RunError("cannot write standard output: " + std::generic_category().message(error));
}

}  // namespace

Messages& messages() {
    static Messages of_the_process;
    return of_the_process;
}

void say_text(std::string_view text) { messages().say_text(text); }

void put_text(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail(errno);
}

void finish_standard_output() {
    if (std::fflush(stdout) != 0) fail(errno);
}

}  // namespace tumble
