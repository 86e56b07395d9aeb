#include "page/run_html.h"

#include "core/html_text.h"
#include "page/run_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tumble {
namespace {

constexpr double nothing = 1e-12;  // J: elastic energy and work below are not worth a row

std::string body_label(const PageRun& run, std::size_t body) {
    const std::string& name = run.scene.bodies.at(body).name;
    const bool number = name.find_first_not_of("0123456789") == std::string::npos;
    return html_text(number ? "body " + name : name);
}

std::string count_html(std::int64_t count) {
    std::string digits = std::to_string(count);
    for (std::ptrdiff_t at = std::ptrdiff_t(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(std::size_t(at), "\u2009");
    return digits;
}

std::string counted(std::size_t count, const char* one, const char* many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string with_unit(double value, const char* unit, int digits = 4) {
    return fmt::format("{}&#8239;{}", number_html(value, digits), unit);
}

std::string figure_item(std::string_view term, const std::string& value, const std::string& note = {}) {
    return fmt::format("<div><dt>{}</dt><dd>{}{}</dd></div>\n", term, value,
                       note.empty() ? "" : fmt::format("<span class=\"note\">{}</span>", note));
}

std::string energy_row(std::string_view name, double start, double end, std::string_view kind = {}) {
    return fmt::format("<tr{}><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                       kind.empty() ? "" : fmt::format(" class=\"{}\"", kind), name, number_html(start, 5),
                       number_html(end, 5), number_html(end - start, 5));
}

std::string count_row(std::string_view name, std::int64_t count, std::int64_t of) {
    const double share = of > 0 ? 100.0 * double(count) / double(of) : 0.0;
    return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.1f}&#8239;%</td></tr>\n", name,
                       count_html(count), share);
}

constexpr const char* state_names[] = {"sticking", "sliding", "asleep", "touching without load"};
constexpr const char* feature_names[] = {"vertex on face", "face on vertex", "edge on edge",
                                         "face on face",   "sphere",         "mesh"};

/// The caption of a table of counts, which count the kept records.
std::string counts_caption(const char* what, std::int64_t kept, std::int64_t all) {
    return kept == all ? what : fmt::format("{}, the {} strongest of {}", what, count_html(kept), count_html(all));
}

template <class Counts, class Names>
std::string counts_table(std::string_view caption, std::string_view column, const Counts& counts, const Names& names) {
    std::int64_t sum = 0;
    for (const std::int64_t count : counts) sum += count;
    std::string html = fmt::format(
        "<table class=\"numbers\"><caption>{}</caption>\n<thead><tr><th></th><th scope=\"col\">{}</th>"
        "<th scope=\"col\">share</th></tr></thead>\n<tbody>\n",
        caption, column);
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (counts[i] > 0) html += count_row(names[i], counts[i], sum);
    if (sum == 0) html += "<tr><th scope=\"row\">none</th><td>0</td><td></td></tr>\n";
    return html + "</tbody></table>\n";
}

std::string impact_sentence(const PageRun& run, const ImpactStatistics& impacts) {
    if (impacts.count == 0) return "<p>There are no impacts.</p>\n";
    return fmt::format(
        "<p>{} at contact points. The largest is {}, between {} and {} at {}; the largest approach speed is {}.</p>\n",
        impacts.count == 1 ? "One impulse acts" : count_html(impacts.count) + " impulses act",
        with_unit(impacts.largest_impulse, "N&#8239;s"), body_label(run, impacts.a), body_label(run, impacts.b),
        with_unit(impacts.largest_time, "s"), with_unit(impacts.fastest, "m/s"));
}

}  // namespace

std::string number_html(double value, int digits) {
    std::string text = fmt::format("{:.{}g}", value == 0.0 ? 0.0 : value, digits);
    const std::size_t exponent = text.find('e');
    const auto signed_text = [](const std::string& part) {
        return part.starts_with('-') ? "\u2212" + part.substr(1) : part;
    };
    if (exponent == std::string::npos) return signed_text(text);
    const std::string mantissa = text.substr(0, exponent);
    const std::string power = signed_text(std::to_string(std::stoi(text.substr(exponent + 1))));
    return fmt::format("{}&#8239;\u00d7&#8239;10<sup>{}</sup>", signed_text(mantissa), power);
}

std::string summary_of(const PageRun& run) {
    const SceneDescription& scene = run.scene;
    const auto moving =
        std::size_t(std::ranges::count_if(scene.bodies, [](const auto& b) { return b.type != BodyType::fixed; }));
    std::string text = counted(scene.bodies.size(), "body", "bodies");
    if (moving != scene.bodies.size() && scene.bodies.size() > 1) text += fmt::format(", {} of them in motion", moving);
    text += fmt::format("; {:g} s", double(run.frames - 1) / scene.output.fps);
    text += fmt::format("; {}, a step of {:.4g} ms", run.integrator, 1e3 * scene.step());
    if (scene.simulation.impacts == ImpactMode::exact) text += ", impacts at their own times";
    if (scene.simulation.method == SimulationMethod::notes) text += ", the method of the course notes";
    return text;
}

std::string masthead_html(const std::string& title, const std::string& eyebrow, const std::string& lead) {
    std::string html = "<header class=\"masthead\">\n";
    if (!eyebrow.empty()) html += fmt::format("<p class=\"eyebrow\">{}</p>\n", html_text(eyebrow));
    html += fmt::format("<h1>{}</h1>\n", html_text(title));
    if (!lead.empty()) html += fmt::format("<p class=\"lead\">{}</p>\n", html_text(lead));
    return html + "</header>\n";
}

std::string key_figures_html(const PageRun& run, const ClipData& data) {
    const EnergyBalance energy = energy_balance(run);
    const ContactStatistics contacts = contact_statistics(run);
    const ImpactStatistics impacts = impact_statistics(run);
    const double share = energy.scale > 0.0 ? 100.0 * energy.largest_residual / energy.scale : 0.0;
    std::string html = "<dl class=\"figures\">\n";
    html += figure_item("Clip", with_unit(double(run.frames - 1) / run.scene.output.fps, "s"),
                        fmt::format("{} frames", count_html(run.frames)));
    html += figure_item("Step", with_unit(1e3 * run.scene.step(), "ms"), html_text(run.integrator));
    html += figure_item("Impacts", count_html(impacts.count),
                        run.scene.simulation.impacts == ImpactMode::exact ? "at their own times" : "at the step");
    html += figure_item("Energy residual", with_unit(energy.largest_residual, "J", 2),
                        fmt::format("{}&#8239;% of the largest energy", number_html(share, 2)));
    html += figure_item("Deepest overlap", with_unit(1e3 * contacts.deepest, "mm", 2),
                        contacts.deepest > 0.0 ? "at " + with_unit(contacts.deepest_time, "s") : "");
    html += figure_item("Error of this page", with_unit(1e3 * data.errors.position, "mm", 2),
                        with_unit(data.errors.rotation, "rad", 2));
    return html + "</dl>\n";
}

std::string energy_html(const PageRun& run) {
    const EnergyBalance energy = energy_balance(run);
    const EnergySample &a = energy.start, &b = energy.end;
    const bool elastic = std::ranges::any_of(run.energy, [](const auto& e) { return std::abs(e.elastic) > nothing; });
    const bool work = std::ranges::any_of(run.energy, [](const auto& e) { return std::abs(e.work) > nothing; });
    std::string html =
        "<table class=\"numbers\"><caption>Energies in joules</caption>\n<thead><tr><th></th><th "
        "scope=\"col\">start</th>"
        "<th scope=\"col\">end</th><th scope=\"col\">change</th></tr></thead>\n<tbody>\n";
    html += energy_row("kinetic, translation", a.kinetic_linear, b.kinetic_linear);
    html += energy_row("kinetic, rotation", a.kinetic_angular, b.kinetic_angular);
    html += energy_row("potential", a.potential, b.potential);
    if (elastic) html += energy_row("elastic", a.elastic, b.elastic);
    html += energy_row("total", total_energy(a), total_energy(b), "sum");
    html += energy_row("+ losses by impacts", a.impact_loss, b.impact_loss);
    html += energy_row("+ losses by friction", a.friction_loss, b.friction_loss);
    if (work) html += energy_row("\u2212 work of drives, wind and forces", a.work, b.work);
    html += energy_row("balance", balance_of(a), balance_of(b), "sum");
    html += "</tbody></table>\n";
    const double share = energy.scale > 0.0 ? 100.0 * energy.largest_residual / energy.scale : 0.0;
    return html +
           fmt::format(
               "<p>The balance is constant but for the errors of the simulation: it is off by {} at most, at {}, "
               "which is {}&#8239;% of the largest change of an energy.</p>\n",
               with_unit(energy.largest_residual, "J", 2), with_unit(energy.residual_time, "s"), number_html(share, 2));
}

std::string contacts_html(const PageRun& run) {
    const ContactStatistics contacts = contact_statistics(run);
    const ImpactStatistics impacts = impact_statistics(run);
    std::string html = impact_sentence(run, impacts);
    if (contacts.most > 0)
        html += fmt::format(
            "<p>Up to {} contact points touch in a frame, with a normal force of up to {}. The deepest overlap is {}, "
            "at {}.</p>\n",
            count_html(contacts.most), with_unit(contacts.largest_force, "N"),
            with_unit(1e3 * contacts.deepest, "mm", 3), with_unit(contacts.deepest_time, "s"));
    html += "<div class=\"columns\">\n";
    html += counts_table(counts_caption("Contact points by state", contacts.kept, contacts.count),
                         "points in all frames", contacts.by_state, state_names);
    html += counts_table(counts_caption("Contact points by features", contacts.kept, contacts.count),
                         "points in all frames", contacts.by_features, feature_names);
    html += counts_table(counts_caption("Impulses by features", impacts.kept, impacts.count), "impulses",
                         impacts.by_features, feature_names);
    return html + "</div>\n";
}

std::string shares_html(const std::string& caption, std::span<const ShareRow> rows, const std::string& unit) {
    double largest = 0.0;
    for (const ShareRow& row : rows) largest = std::max(largest, row.value);
    std::string html = fmt::format("<table class=\"shares\"><caption>{}</caption>\n<tbody>\n", html_text(caption));
    for (const ShareRow& row : rows)
        html += fmt::format(
            "<tr><th scope=\"row\">{}</th><td class=\"bar\" aria-hidden=\"true\"><span style=\"width:{:.1f}%\"></span>"
            "</td><td>{:.2f}&#8239;{}</td></tr>\n",
            html_text(row.name), largest > 0.0 ? 100.0 * row.value / largest : 0.0, row.value, html_text(unit));
    return html + "</tbody></table>\n";
}

std::string pairs_html(const std::string& caption, std::span<const std::pair<std::string, std::string>> rows) {
    std::string html = fmt::format("<table class=\"pairs\"><caption>{}</caption>\n<tbody>\n", html_text(caption));
    for (const auto& [name, value] : rows)
        html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", html_text(name), html_text(value));
    return html + "</tbody></table>\n";
}

std::string sources_html(std::span<const PageSource> sources) {
    std::string html;
    for (const PageSource& source : sources)
        html += fmt::format(
            "<details class=\"source\"{}><summary>{}</summary>\n<pre tabindex=\"0\"><code>{}</code></pre></details>\n",
            html.empty() ? " open" : "", html_text(source.name), html_text(source.text));
    return html;
}

}  // namespace tumble
