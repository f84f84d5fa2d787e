#include "dashboard/viewer_parameters.hpp"

#include <algorithm>

namespace constrictor::dashboard {
namespace {

constexpr std::size_t kMostNames = 1000;  // that one viewer can name

}  // namespace

void ViewerParameters::subscribe(const std::vector<std::string>& names, const ParameterMap& present) {
  for (const auto& [name, parameter] : present) {
    const bool named = names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    if (named && !wants(name)) known_.insert_or_assign(name, parameter.value);
  }
  if (names.empty()) {
    all_ = true;
    names_.clear();
  }
  for (const auto& name : names) {
    if (all_) names_.erase(name);
    else if (names_.size() < kMostNames) names_.insert(name);
  }
}

void ViewerParameters::unsubscribe(const std::vector<std::string>& names) {
  if (names.empty()) {
    all_ = false;
    names_.clear();
  }
  for (const auto& name : names) {
    if (!all_) names_.erase(name);
    else if (names_.size() < kMostNames) names_.insert(name);
  }
}

void ViewerParameters::sent(const std::vector<ParameterValue>& values) {
  for (const auto& parameter : values) {
    if (wants(parameter.name)) known_.insert_or_assign(parameter.name, parameter.value);
  }
}

std::vector<ParameterValue> ViewerParameters::news(const ParameterMap& present) {
  std::vector<ParameterValue> news;
  for (const auto& [name, parameter] : present) {
    if (!wants(name)) continue;
    const auto known = known_.find(name);
    if (known != known_.end() && known->second == parameter.value) continue;
    known_.insert_or_assign(name, parameter.value);
    news.push_back(parameter);
  }
  return news;
}

std::vector<ParameterValue> values_of(const std::vector<std::string>& names, const ParameterMap& present,
                                      std::vector<std::string>& missing) {
  std::vector<ParameterValue> values;
  if (names.empty()) {
    for (const auto& entry : present) values.push_back(entry.second);
  }
  for (const auto& name : names) {
    const auto found = present.find(name);
    if (found == present.end()) missing.push_back(name);
    else values.push_back(found->second);
  }
  return values;
}

}  // namespace constrictor::dashboard
