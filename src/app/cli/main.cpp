#include "app/cli/options.h"
#include "app/cli/say.h"
#include "app/cli/standard_streams.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "tumble/error.h"

#include <csignal>
#include <exception>
#include <new>

int main(int argc, char** argv) {
    tumble::open_missing_standard_streams();
    // A file beyond the user's size limit, and a pipe without a reader, then give an error of the write, like a full
    // disk.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    try {
        const int code = tumble::run_command_line(argc, argv);
        tumble::finish_standard_output();
        return code;
    } catch (const tumble::InputError& error) {
        tumble::say("{}\n", error.what());
        return 2;
    } catch (const tumble::RunError& error) {
        tumble::say("{}\n", error.what());
        return 1;
    } catch (const tumble::v0::Error& error) {
        tumble::say("{}\n", error.what());
        return error.kind() == tumble::v0::ErrorKind::input ? 2 : 1;
    } catch (const std::bad_alloc&) {
        tumble::say_text("error: out of memory\n");
        return 1;
    } catch (const std::exception& error) {
        tumble::say("error: {}\n", tumble::safe_lines(error.what()));
        return 1;
    }
}
