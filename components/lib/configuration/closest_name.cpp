#include "configuration/closest_name.hpp"

#include <algorithm>
#include <cctype>

namespace constrictor {
namespace {

constexpr std::size_t kLongestName = 64;  // the comparison takes time in proportion to the product of the lengths

char lower(char letter) { return static_cast<char>(std::tolower(static_cast<unsigned char>(letter))); }

/// Number of letters to change, insert, delete or swap with the next one (optimal string alignment distance).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string closest_name(std::string_view name, const std::vector<std::string>& candidates) {
  if (name.size() > kLongestName) return {};
  std::string best;
  std::size_t fewest = 0;
  for (const auto& candidate : candidates) {
    const std::size_t wrong = distance(name, candidate);
    if (3 * wrong > std::max(name.size(), candidate.size()) || (!best.empty() && wrong >= fewest)) continue;
    best = candidate;
    fewest = wrong;
  }
  if (!best.empty() || name.size() < 2) return best;
  const auto longer = std::find_if(candidates.begin(), candidates.end(),
                                   [&](const std::string& candidate) { return candidate.starts_with(name); });
  return longer == candidates.end() ? best : *longer;
}

bool is_slip_of(std::string_view found, std::string_view meant) {
  constexpr std::size_t kShortest = 4;  // a shorter name with another letter is another name, as x_m and y_m
  constexpr std::size_t kShortestBeginning = 3;
  if (std::max(found.size(), meant.size()) > kLongestName) return false;
  const bool begins = found.starts_with(meant) || meant.starts_with(found);
  if (begins && std::min(found.size(), meant.size()) >= kShortestBeginning) return true;
  return std::max(found.size(), meant.size()) >= kShortest && distance(found, meant) <= 1;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string closest = closest_name(name, candidates);
  return closest.empty() || closest == name ? "" : ", did you mean '" + closest + "'?";
}

}  // namespace constrictor
