#include "app/cli/commands.h"
#include "app/cli/say.h"
#include "app/manual/completion.h"
#include "app/manual/man_page.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"

#include <system_error>

namespace tumble {

void run_completion(const CompletionCommand& command, const manual::CommandText& program) {
    put_text(command.shell == "bash"  ? manual::bash_completion(program)
             : command.shell == "zsh" ? manual::zsh_completion(program)
                                      : manual::fish_completion(program));
    finish_standard_output();
}

void run_man_pages(const ManPagesCommand& command, const manual::CommandText& program) {
    std::error_code failed;
    std::filesystem::create_directories(command.folder, failed);
    if (failed)
        throw RunError(fmt::format("cannot make the folder '{}': {}", safe_path(command.folder), failed.message()));
    for (const manual::ManPage& page : manual::man_pages(program, TUMBLE_VERSION))
        write_file(command.folder / page.file, page.text);
}

}  // namespace tumble
