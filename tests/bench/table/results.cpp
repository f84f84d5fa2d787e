#include "bench/table/results.hpp"

#include <array>
#include <fstream>

#include "configuration/quantiles.hpp"

namespace constrictor::bench {
namespace {

using nlohmann::json;

/// The files of scripts/bench.sh in the form of Google Benchmark. The folder may hold other files.
constexpr std::array kParts{"world.json",  "tick.json",    "camera.json",   "perception.json",
                            "growth.json", "members.json", "renderers.json"};

/// [ms] CPU time of a result; a part that measures itself reports its time as the real one.
double time_ms(const json& result, const std::string& name) {
  const std::string unit = result.value("time_unit", "ms");
  const double scale = unit == "ns" ? 1e-6 : unit == "us" ? 1e-3 : 1.0;
  return scale * result.value(name.ends_with("/manual_time") ? "real_time" : "cpu_time", 0.0);
}

}  // namespace

Results::Results(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::map<std::string, std::vector<double>> repetitions;
  for (const char* part : kParts) {
    for (const json& result : benchmarks(part)) {
      if (result.value("run_type", "") != "iteration") continue;
      const std::string name = result.value("name", "");
      if (result.value("error_occurred", false)) errors_[name] = result.value("error_message", "");
      else repetitions[name].push_back(time_ms(result, name));
    }
  }
  for (const auto& [name, values] : repetitions) times_ms_[name] = interpolated_quantile(values, 0.5);
}

std::map<std::string, double> Results::group_ms(const std::string& group) const {
  std::map<std::string, double> found;
  for (const auto& [name, ms] : times_ms_) {
    if (!name.starts_with(group + "/")) continue;
    const std::string rest = name.substr(group.size() + 1);
    found[rest.substr(0, rest.find('/'))] = ms;
  }
  return found;
}

json Results::file(const std::string& name) const {
  std::ifstream stream(folder_ / name);
  return json::parse(stream, nullptr, false);
}

std::vector<json> Results::benchmarks(const std::string& name) const {
  const json found = file(name);
  return found.is_object() ? found.value("benchmarks", std::vector<json>{}) : std::vector<json>{};
}

}  // namespace constrictor::bench
