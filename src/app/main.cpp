#include "app/options.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

int main(int argc, char** argv) {
    // A file that grows beyond the user's limit is then an error of the write that did it, like a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return tumble::run_command_line(argc, argv);
    } catch (const tumble::InputError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    } catch (const tumble::RunError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "error: out of memory\n");
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", tumble::safe_lines(error.what()));
        return 1;
    }
}
