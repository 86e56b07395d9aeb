// Parts of a page about its runs: facts, tables of energy and contacts, sources. All functions return HTML.
#pragma once

#include "page/clip_data.h"
#include "page/page_run.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// "6.02 x 10^23" in HTML, with that many significant digits.
std::string number_html(double value, int digits = 4);

/// "101 bodies (100 of them move), 5 s at 60 frames/s, ...", plain text: for a lead and for readers that do not see it.
std::string summary_of(const PageRun& run);

/// <h1> with a line of facts below it. `eyebrow`: above the title, may be empty.
std::string masthead_html(const std::string& title, const std::string& eyebrow, const std::string& lead);

/// The main figures of a run as a list of terms.
std::string key_figures_html(const PageRun& run, const ClipData& data);

/// Start, end and change of each energy, and the largest residual of the balance.
std::string energy_html(const PageRun& run);
/// Contacts by state and by features, the deepest overlap, and the impacts.
std::string contacts_html(const PageRun& run);

/// A row of a table of shares: seconds of a stage.
struct ShareRow {
    std::string name;
    double value = 0.0;
};
/// Bars of the rows' shares of the largest one. `unit`: "s".
std::string shares_html(const std::string& caption, std::span<const ShareRow> rows, const std::string& unit);

/// A table of two columns, plain text.
std::string pairs_html(const std::string& caption, std::span<const std::pair<std::string, std::string>> rows);

/// Each source in a block that opens and closes; the first one is open.
std::string sources_html(std::span<const PageSource> sources);

}  // namespace tumble
