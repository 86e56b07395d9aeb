// The page about a render: --report.
#pragma once

#include "app/cli/page_clip.h"
#include "app/cli/render_run.h"
#include "page/page_shell.h"

namespace tumble {

class RenderReport {
public:
    /// Loads the scenes and the template before the render, so that a missing player is found at once. Throws
    /// InputError or RunError.
    explicit RenderReport(const RenderCommand& command);
    /// Simulates the scenes once more for the page, draws its film, and writes it.
    void write(const RenderFigures& done) const;

private:
    PageFilm draw() const;
    std::string body_html(const PageClip& clip, const ClipData& data, const RenderFigures& done) const;

    const RenderCommand& command_;
    PageScenes scenes_;
    PageTemplate template_;
};

}  // namespace tumble
