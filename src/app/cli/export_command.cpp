#include "app/cli/commands.h"
#include "app/cli/export_run.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"
#include "scene/load.h"

#include <fmt/format.h>

namespace tumble {

void run_export(const ExportCommand& command) {
    if (command.output.extension() != ".glb")
        throw InputError(fmt::format("-o {}: the name must end with .glb", safe_path(command.output)));
    FileList inputs;
    const SceneDescription scene = load_scene(command.scene, command.overrides, &inputs);
    OutputPlan plan;
    plan.add_inputs(inputs);
    plan.add("-o", command.output);

    TemporaryFile file(command.output);
    ExportedScene exported;
    {
        Interrupt interrupt;
        exported = export_scene(scene, command.keys, command.threads, command.quiet, interrupt);
        file.write(exported.bytes);
    }
    file.commit();
    if (!command.quiet)
        say("wrote {} ({:.4g} kB; largest error {:.2g} m, {:.2g} rad)\n", safe_path(command.output),
            1e-3 * double(exported.bytes.size()), exported.position_error, exported.rotation_error);
}

}  // namespace tumble
