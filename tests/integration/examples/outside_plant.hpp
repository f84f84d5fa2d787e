// The examples that drive joints for plant_relay, beside a real run, and checked by `constrictor conform`.
#pragma once

#include <signal.h>

#include <cmath>

#include "cyclone/domain_claim.hpp"
#include "example_run.hpp"

namespace constrictor::testing {

using namespace std::chrono_literals;

class OutsidePlant : public ExampleRun {
 protected:
  /// What the test itself reads of the hardware's topics and of plant_relay.
  struct Eyes {
    explicit Eyes(unsigned domain)
        : here(domain),
          states(dds::Reader<msg::HardwareJointState>::observer(here.participant(), "hardware/joint_state", 64)),
          commands(dds::Reader<msg::HardwareJointCommand>::observer(here.participant(), "hardware/joint_command", 64)),
          statuses(dds::Reader<msg::ComponentStatus>::observer(here.participant(), "component_status", 64)) {}
    void look() {
      states.take([this](const msg::HardwareJointState& state) {
        ++state_count;
        for (int i = 0; i < 23; ++i) largest_rad = std::max(largest_rad, std::abs(state.position_rad[i]));
      });
      commands.take([this](const msg::HardwareJointCommand& command) {
        ++command_count;
        session = command.session;
      });
      statuses.take([this](const msg::ComponentStatus& status) {
        if (std::string(status.component) == "plant_relay") refusal = status.last_refusal;
      });
    }
    template <class Condition>
    bool until(Condition condition) {
      return eventually([&] {
        look();
        return condition();
      });
    }
    dds::Domain here;
    dds::Reader<msg::HardwareJointState> states;
    dds::Reader<msg::HardwareJointCommand> commands;
    dds::Reader<msg::ComponentStatus> statuses;
    std::uint64_t state_count = 0, command_count = 0, session = 0;
    double largest_rad = 0.0;
    std::string refusal;
  };

  void moves(Eyes& eyes, unsigned domain) {
    eyes.largest_rad = 0.0;
    Process drive({std::string(CONSTRICTOR_PREFIX) + "/bin/constrictor", "teleop", "--drive", "0.3,0", "--for", "1.5s"},
                  {{"CONSTRICTOR_DOMAIN", std::to_string(domain)}});
    EXPECT_TRUE(eyes.until([&] { return eyes.largest_rad > 0.15; })) << eyes.refusal;
    EXPECT_EQ(drive.wait(20s), 0) << drive.output() << drive.errors();
  }

  void is_driven(const std::string& name) {
    Process launcher = run("line", {"--manifest", "outside_plant"});
    const unsigned domain = domain_of(launcher);
    ASSERT_GT(domain, 0u) << launcher.output() << launcher.errors();
    Eyes eyes(domain);
    auto hardware =
        std::make_unique<Process>(std::vector<std::string>{example(name), "--domain", std::to_string(domain)});
    ASSERT_TRUE(eyes.until([&] { return eyes.command_count > 10 && eyes.state_count > 10; }))
        << hardware->output() << hardware->errors() << launcher.output();
    EXPECT_LT(eyes.largest_rad, 0.01) << "the start moves nothing";
    moves(eyes, domain);

    hardware->signal(SIGSTOP);
    ASSERT_TRUE(eyes.until([&] { return eyes.refusal.find("hardware: lost") != std::string::npos; })) << eyes.refusal;
    const std::uint64_t before = eyes.command_count;
    hardware->signal(SIGCONT);
    ASSERT_TRUE(eyes.until([&] { return eyes.command_count > before + 10; })) << eyes.refusal;
    moves(eyes, domain);

    hardware->signal(SIGKILL);
    hardware->wait(10s);
    hardware = std::make_unique<Process>(std::vector<std::string>{example(name), "--domain", std::to_string(domain)});
    const std::uint64_t then = eyes.command_count;
    ASSERT_TRUE(eyes.until([&] { return eyes.command_count > then + 30; })) << eyes.refusal;
    moves(eyes, domain);
    hardware->signal(SIGTERM);
    EXPECT_EQ(hardware->wait(10s), 0);
    launcher.signal(SIGTERM);
    EXPECT_TRUE(launcher.wait(20s));
  }

  /// Checks the process without a run, in a domain of its own. Returns the results.
  nlohmann::json conforms(const std::string& name, const std::vector<std::string>& more = {}) {
    const DomainClaim claim;
    const std::string domain = std::to_string(claim.domain());
    std::vector<std::string> arguments = {example(name), "--domain", domain};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process hardware(arguments);
    write("quick.yaml", "joints: [0, 3]\nmotion: {settle_s: 0.12, rate_rad_s: 0.8}\n");
    Process conform({std::string(CONSTRICTOR_PREFIX) + "/bin/constrictor", "conform", "plant", "--domain", domain,
                     "--yes", "--profile", (dir_ / "quick.yaml").string(), "--json", (dir_ / "result.json").string()});
    status_ = conform.wait(60s).value_or(-1);
    output_ = conform.output() + conform.errors();
    return nlohmann::json::parse(std::ifstream(dir_ / "result.json"), nullptr, false);
  }
  void keeps_the_contract(const std::string& name) {
    const nlohmann::json result = conforms(name);
    EXPECT_EQ(status_, 0) << output_;
    ASSERT_TRUE(result.is_object()) << output_;
    EXPECT_TRUE(result["conforms"].get<bool>()) << output_;
  }
  int status_ = -1;
  std::string output_;
};

}  // namespace constrictor::testing
