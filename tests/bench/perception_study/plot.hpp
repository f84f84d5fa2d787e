// The curves of the perception study: a panel for each error.
#pragma once

#include <string>
#include <vector>

#include "bench/perception_study/study.hpp"
#include "sim/figure/canvas.hpp"

namespace constrictor::perception_study {

/// The bytes of the picture. Each panel has three strips over the levels: the share of missions that succeeded with its
/// 95 % interval, the distance of dropped objects from the centre of their zone, and the time of successful missions,
/// both as median and quartiles. The levels are drawn at equal distances. Factors without results are left out.
[[nodiscard]] std::string draw(figure::Format format, const std::string& title, const std::vector<Factor>& factors,
                               const std::vector<std::vector<LevelResult>>& results);

}  // namespace constrictor::perception_study
