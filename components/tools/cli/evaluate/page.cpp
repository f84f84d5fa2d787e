#include "cli/evaluate/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "cli/evaluate/svg_chart.hpp"
#include "configuration/xml_escaped.hpp"

namespace constrictor::cli {
namespace {

constexpr std::size_t kMostCurves = 7;  // in one chart
constexpr std::size_t kMostBars = 20;

constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #262626; background: #fff; }
body { max-width: 1360px; margin: 0 auto; padding: 16px; }
h1 { font-size: 24px; margin: 0 0 4px; }
h2 { font-size: 18px; margin: 28px 0 8px; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 480px), 1fr)); gap: 24px; }
svg { width: 100%; height: auto; font: 12px system-ui, sans-serif; }
svg text { fill: #262626; }
svg .title { font-size: 14px; font-weight: 600; }
svg .grid { stroke: #ddd; }
svg .whisker { stroke: #262626; stroke-width: 1.5; }
.table { overflow-x: auto; }
table { border-collapse: collapse; }
th, td { text-align: left; padding: 3px 12px 3px 0; border-bottom: 1px solid #e4e4e4; vertical-align: top; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
code { font-size: 12px; overflow-wrap: anywhere; }
.bad { color: #a33000; }
.note { color: #555; }
)";

std::string known(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

std::string interval_text(std::size_t reached, std::size_t runs) {
  const Interval interval = wilson_interval(reached, runs);
  return fmt::format("{:.0f} to {:.0f} %", 100 * interval.low, 100 * interval.high);
}

std::string worst_recovery(const VariantSummary& summary) {
  if (!std::isfinite(summary.worst_recovery.duration_s)) return "–";
  return fmt::format("{:.1f} s (<a href=\"{}/\">seed {}</a>)", summary.worst_recovery.duration_s,
                     xml_escaped(summary.worst_folder.string()), summary.worst_seed);
}

std::string overview(const std::vector<VariantSummary>& summaries) {
  std::string html =
      "<div class=\"table\"><table><tr><th>variant</th><th class=\"n\">runs</th><th class=\"n\">succeeded</th>"
      "<th>95 % interval</th><th class=\"n\">believed, but not true</th>"
      "<th class=\"n\">true, but not noticed</th><th class=\"n\">errors</th>"
      "<th class=\"n\">refused</th>"
      "<th class=\"n\">median time</th><th class=\"n\">median placement</th><th class=\"n\">95 % of placements</th>"
      "<th class=\"n\">cost of transport</th><th class=\"n\">longest recovery</th></tr>\n";
  for (const auto& summary : summaries) {
    html += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{} s</td><td "
        "class=\"n\">{} m</td><td "
        "class=\"n\">{} m</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
        xml_escaped(summary.name), summary.runs, summary.successes(),
        interval_text(summary.successes(), summary.begun()), summary.false_successes, summary.unnoticed_successes,
        summary.errors, summary.refused, known(summary.mission_time_s.at(0.5), 1),
        known(summary.placement_m.at(0.5), 3), known(summary.placement_m.at(0.95), 3),
        known(summary.cost_of_transport.at(0.5), 2), worst_recovery(summary));
  }
  return html + "</table></div>\n";
}

std::string phases(const std::vector<VariantSummary>& summaries) {
  std::vector<Bar> bars;
  const std::size_t shown = std::min<std::size_t>(summaries.size(), 4);
  for (std::size_t phase = 0; phase < std::size(kPhases); ++phase) {
    for (std::size_t i = 0; i < shown; ++i) {
      const VariantSummary& summary = summaries[i];
      const double share =
          summary.begun() == 0 ? 0 : static_cast<double>(summary.reached[phase]) / static_cast<double>(summary.begun());
      const Interval interval = wilson_interval(summary.reached[phase], summary.begun());
      bars.push_back({i == 0 ? kPhases[phase] : "",
                      100 * share,
                      fmt::format("{} of {}", summary.reached[phase], summary.begun()),
                      summary.begun() > 0,
                      {100 * interval.low, 100 * interval.high},
                      i});
    }
  }
  const std::string which = summaries.size() > shown ? fmt::format(" (the first {} variants)", shown) : "";
  std::vector<std::string> key;
  for (std::size_t i = 0; i < shown && summaries.size() > 1; ++i) key.push_back(summaries[i].name);
  return bar_chart("Success by phase" + which, bars, 100, "% of runs, with the 95 % interval (Wilson)", key);
}

/// The share of the values up to each value, for each variant.
std::string cumulative(const std::string& title, const std::string& x_label,
                       const std::vector<VariantSummary>& summaries, const Distribution VariantSummary::*which) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < std::min(summaries.size(), kMostCurves); ++i) {
    std::vector<double> values = (summaries[i].*which).values;
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    Curve curve{summaries[i].name, {{values.front(), 0, false, {}}}, true};
    for (std::size_t k = 0; k < values.size(); ++k)
      curve.points.push_back(
          {values[k], 100.0 * static_cast<double>(k + 1) / static_cast<double>(values.size()), false, {}});
    curves.push_back(std::move(curve));
  }
  return curves.empty() ? "" : curve_chart(title, curves, x_label, "% of values up to this one", 100);
}

std::optional<double> as_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// If exactly one number is varied: success, placement and time over it.
std::string over_the_value(const std::vector<Variant>& variants, const std::vector<VariantSummary>& summaries) {
  Curve success{"", {}}, placement{"", {}}, time{"", {}};
  std::string name;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    if (variants.size() < 2 || variants[i].settings.size() != 1) return {};
    const Setting& setting = variants[i].settings.front();
    const auto x = as_number(setting.value);
    if (!x) return {};
    name = setting.file == "scenario" ? setting.key : setting.file + ":" + setting.key;
    const VariantSummary& summary = summaries[i];
    if (summary.begun() == 0) continue;
    const Interval interval = wilson_interval(summary.successes(), summary.begun());
    success.points.push_back({*x,
                              100.0 * static_cast<double>(summary.successes()) / static_cast<double>(summary.begun()),
                              true,
                              {100 * interval.low, 100 * interval.high}});
    const auto add = [&](Curve& curve, const Distribution& values) {
      if (!values.values.empty())
        curve.points.push_back({*x, values.at(0.5), true, {values.at(0.25), values.at(0.75)}});
    };
    add(placement, summary.placement_m);
    add(time, summary.mission_time_s);
  }
  for (Curve* curve : {&success, &placement, &time}) {
    std::sort(curve->points.begin(), curve->points.end(),
              [](const CurvePoint& a, const CurvePoint& b) { return a.x < b.x; });
  }
  return curve_chart("Success over " + name, {success}, name, "% of runs (95 % interval)", 100) +
         curve_chart("Placement over " + name, {placement}, name, "distance from the zone's centre [m], quartiles") +
         curve_chart("Mission time over " + name, {time}, name, "simulated time [s], quartiles");
}

std::string times(const std::vector<VariantSummary>& summaries) {
  if (summaries.empty() || summaries.front().mean_time_in_state_s.empty()) return {};
  std::vector<Bar> bars;
  double longest = 0;
  for (const auto& [state, time_s] : summaries.front().mean_time_in_state_s) {
    bars.push_back({state, time_s, fmt::format("{:.1f} s", time_s)});
    longest = std::max(longest, time_s);
  }
  std::sort(bars.begin(), bars.end(), [](const Bar& a, const Bar& b) { return a.value > b.value; });
  if (bars.size() > kMostBars) bars.resize(kMostBars);
  const std::string which = summaries.size() > 1 ? ", " + summaries.front().name : "";
  return bar_chart("Mean time in each state of the planner" + which, bars, longest, "simulated time of a run [s]");
}

std::string causes(const std::vector<VariantSummary>& summaries) {
  std::map<std::string, int> sums;
  for (const auto& summary : summaries) {
    for (const auto& [cause, count] : summary.recoveries_by_cause) sums[cause] += count;
  }
  if (sums.empty()) return "<p>No run had a recovery.</p>\n";
  std::vector<std::pair<std::string, int>> rows(sums.begin(), sums.end());
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string html =
      "<div class=\"table\"><table><tr><th>state that a recovery ended, and why</th><th class=\"n\">number</th></tr>\n";
  for (const auto& [cause, count] : rows)
    html += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td></tr>\n", xml_escaped(cause), count);
  return html + "</table></div>\n";
}

std::string run_rows(const PageContent& content, bool successes) {
  std::string rows;
  for (const auto& result : content.results) {
    if (result.success != successes) continue;
    double worst_m = kUnknown;
    for (const auto& object : result.objects) worst_m = std::fmax(worst_m, object.zone_distance_m);
    rows += fmt::format(
        "<tr><td><a href=\"{}/\">{}</a></td><td>{}</td><td class=\"{}\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
        xml_escaped(result.folder.string()), result.seed, xml_escaped(content.variants.at(result.variant).name),
        successes ? "" : "bad",
        successes ? "succeeded"
                  : xml_escaped((result.error() || result.refused ? result.kind() : "") + result.reason +
                                (result.unnoticed() ? " (all objects lie in their zones)" : "")),
        known(result.mission_time_s, 1), known(worst_m, 2), result.recoveries,
        known(result.longest_recovery.duration_s, 1), xml_escaped(result.longest_recovery.cause),
        xml_escaped(result.command));
  }
  return rows;
}

std::string run_table(const std::string& rows) {
  return "<div class=\"table\"><table><tr><th>seed</th><th>variant</th><th>outcome</th><th class=\"n\">time [s]</th>"
         "<th class=\"n\">worst placement [m]</th><th class=\"n\">recoveries</th>"
         "<th class=\"n\">longest recovery [s]</th><th>its cause</th><th>command that repeats "
         "it</th></tr>\n" +
         rows + "</table></div>\n";
}

}  // namespace

std::string make_page(const PageContent& content) {
  const auto summaries = summarise(content.variants, content.results);
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>Evaluation of {0}</title>"
      "<style>{1}</style></head>\n<body><h1>Evaluation of {0}</h1>\n<p class=\"note\">{2}</p>\n",
      xml_escaped(content.scenario), kStyle, xml_escaped(content.about));
  if (content.results.size() < content.planned) {
    html += fmt::format("<p class=\"bad\">{} of {} runs are done; the others are missing in all figures.</p>\n",
                        content.results.size(), content.planned);
  }
  html += overview(summaries) + "<h2>Figures</h2>\n<div class=\"charts\">\n" +
          over_the_value(content.variants, summaries) + phases(summaries) +
          cumulative("Placement of dropped objects", "distance from the zone's centre [m]", summaries,
                     &VariantSummary::placement_m) +
          cumulative("Time of successful missions", "simulated time [s]", summaries, &VariantSummary::mission_time_s) +
          cumulative("Cross-track error while following the line", "root mean square of a run [m]", summaries,
                     &VariantSummary::cross_track_m) +
          cumulative("Error of the estimated pose", "root mean square of a run [m]", summaries,
                     &VariantSummary::pose_error_m) +
          cumulative("Cost of transport", "work for each newton of weight and metre", summaries,
                     &VariantSummary::cost_of_transport) +
          times(summaries) + "</div>\n<h2>Recoveries by cause</h2>\n" + causes(summaries);
  const std::string failed = run_rows(content, false);
  html += "<h2>Runs that did not succeed</h2>\n" + (failed.empty() ? "<p>None.</p>\n" : run_table(failed));
  const std::string succeeded = run_rows(content, true);
  if (!succeeded.empty()) html += "<h2>Runs that succeeded</h2>\n" + run_table(succeeded);
  return html + "</body></html>\n";
}

}  // namespace constrictor::cli
