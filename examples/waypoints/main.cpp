// The smallest external planner: it joins a run, sends the robot along a path, and prints the cross-track error.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "client/request_client.hpp"
#include "client/run_registry.hpp"
#include "cyclone/endpoint.hpp"

namespace msg = constrictor::msg;

int main(int argc, char** argv) {
  std::optional<std::uint32_t> domain;
  std::vector<std::string> points = {"0,0", "1,0", "1.5,0.2", "2,0.4", "2.5,0.4", "3,0.4"};
  CLI::App app{"Sends the robot along a path of waypoints, as an external planner."};
  app.add_option("--domain", domain, "DDS domain of the run, as `constrictor run` prints it (default: the only run)")
      ->envname("CONSTRICTOR_DOMAIN");
  app.add_option(
         "--path", points,
         "2 to 64 points X,Y in m; origin and x axis are the robot's pose at the start of the run, y is to its left")
      ->expected(2, static_cast<int>(msg::kMaxPathPoints));
  CLI11_PARSE(app, argc, argv);
  try {
    constrictor::RequestClientOptions options;
    options.source = constrictor::unique_source("waypoints");
    constrictor::RequestClient client(constrictor::find_domain(domain), options);
    client.connect_or_throw();

    msg::Request request = constrictor::task_request(msg::kTaskFollowPath);
    for (const std::string& point : points) {
      const auto i = request.path.point_count++;
      int read = -1;  // characters of the two numbers; what follows them is no part of a point
      std::sscanf(point.c_str(), "%lf,%lf%n", &request.path.x_m[i], &request.path.y_m[i], &read);
      if (read != static_cast<int>(point.size()))
        throw std::runtime_error("--path: found '" + point + "', accepted X,Y");
    }
    const std::uint64_t goal = client.start_goal(request);  // takes authority; throws if the task is refused

    const auto statuses = constrictor::dds::Reader<msg::TaskStatus>::observer(client.participant(), "task/status", 8);
    double squares_m2 = 0, largest_m = 0;
    int count = 0;
    const auto end = client.wait_for_end(goal, [&] {
      statuses.take([&](const msg::TaskStatus& status) {
        if (status.goal_id != goal || !std::isfinite(status.cross_track_m)) return;
        squares_m2 += status.cross_track_m * status.cross_track_m;
        largest_m = std::max(largest_m, std::abs(status.cross_track_m));
        if (count++ % 50 == 0)
          std::printf("%3.0f %% of the path, %+.3f m from it\n", 100 * status.progress, status.cross_track_m);
      });
    });
    client.release();
    std::printf("cross-track error: %.3f m rms, %.3f m at most, in %d ticks\n",
                count > 0 ? std::sqrt(squares_m2 / count) : 0.0, largest_m, count);
    if (end.state != msg::kGoalSucceeded) throw std::runtime_error("the robot stopped on the way: " + end.reason);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "waypoints: %s\n", error.what());
    return 70;
  }
}
