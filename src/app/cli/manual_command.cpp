#include "app/cli/commands.h"
#include "app/cli/say.h"
#include "app/manual/completion.h"
#include "app/manual/man_page.h"
#include "output/confined_path.h"
#include "output/make_folder.h"
#include "output/temporary_file.h"

namespace tumble {

void run_completion(const CompletionCommand& command, const manual::CommandText& program) {
    put_text(command.shell == "bash"  ? manual::bash_completion(program)
             : command.shell == "zsh" ? manual::zsh_completion(program)
                                      : manual::fish_completion(program));
    finish_standard_output();
}

void run_man_pages(const ManPagesCommand& command, const manual::CommandText& program) {
    make_folder(command.folder);
    for (const manual::ManPage& page : manual::man_pages(program, TUMBLE_VERSION))
        write_file(confined_path(command.folder, page.file), page.text);
}

}  // namespace tumble
