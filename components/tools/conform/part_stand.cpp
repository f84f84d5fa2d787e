#include "conform/part_stand.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "barrier/plant_topics.hpp"

namespace constrictor::conform {
namespace {

constexpr std::int64_t kPeriod_ns = 20'000'000;

/// The ports of one component that surrounds the part under test.
class StandPorts {
 public:
  StandPorts(Wiring& wiring, const std::vector<const TopicInfo*>& writes, const std::vector<const TopicInfo*>& observes,
             StandBoard& board)
      : wiring_(wiring), board_(board) {
    for (const TopicInfo* topic : writes) outputs_.push_back(wiring.output_slot(*topic));
    for (const TopicInfo* topic : observes) inputs_.push_back(wiring.input(*topic, true));
  }
  void write() const {
    for (const OutputSlot* output : outputs_) {
      for (const Sample& sample : board_.take(output->topic->id)) output->write(sample.message.get());
    }
  }
  void deliver(const Tick& tick) const {
    std::vector<Letter> arrived;
    for (const InputSlot* input : inputs_) {
      for (const Sample& sample : input->fresh) arrived.push_back({input->topic->id, sample});
    }
    board_.deliver(tick, std::move(arrived));
    if (board_.finished()) wiring_.request_end_of_run();
  }

 private:
  Wiring& wiring_;
  StandBoard& board_;
  std::vector<const OutputSlot*> outputs_;
  std::vector<const InputSlot*> inputs_;
};

class StandPlant final : public Plant {
 public:
  StandPlant(StandPorts ports, StandBoard& board) : ports_(std::move(ports)), board_(board) {}
  void sample(const Tick& tick) override {
    board_.begin_tick(tick);
    ports_.write();
  }
  void step(const Tick& tick) override { ports_.deliver(tick); }
  [[nodiscard]] std::int64_t period_ns() const override { return kPeriod_ns; }

 private:
  StandPorts ports_;
  StandBoard& board_;
};

class StandMember final : public Component {
 public:
  StandMember(StandPorts ports, StandBoard& board, bool leads)
      : ports_(std::move(ports)), board_(board), leads_(leads) {}
  void step(const Tick& tick) override {
    if (leads_) board_.begin_tick(tick);
    ports_.write();
    if (leads_) ports_.deliver(tick);
  }
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}

 private:
  StandPorts ports_;
  StandBoard& board_;
  bool leads_;
};

const std::vector<PartPlace>& places() {
  using namespace topics;
  static const std::vector<PartPlace> all = {
      {"control",
       {&kJointState, &kContactState, &kImuState, &kDesiredTrajectory, &kAuthority, &kRobotPose, &kFieldMap,
        &kLinePercept, &kObjectPercepts},
       {&kJointCommand, &kMotionStatus}},
      {"perception",
       {&kImuState, &kCameraInfo, &kCameraImage, &kTaskStatus},
       {&kLinePercept, &kObjectPercepts, &kProcessedImage}},
      {"planner",
       {&kLinePercept, &kObjectPercepts, &kRobotPose, &kFieldMap, &kTaskStatus, &kTaskEvent, &kAuthority},
       {&kPlannerRequest, &kMissionStatus}},
      {"camera", {&kJointCommand}, {&kCameraInfo, &kCameraImage, &kJointState}, false}};
  return all;
}

}  // namespace

const PartPlace& part_place(const std::string& part) {
  for (const PartPlace& place : places()) {
    if (place.part == part) return place;
  }
  throw std::invalid_argument("conform: no part is named " + part);
}

std::vector<ComponentFactory> stand_factories(const PartPlace& place, StandBoard& board) {
  std::vector<ComponentFactory> factories;
  std::vector<const TopicInfo*> of_plant;
  std::vector<std::pair<std::string, std::vector<const TopicInfo*>>> members;
  for (const TopicInfo* topic : place.writes) {
    if (is_written_by_plant(*topic)) {
      of_plant.push_back(topic);
      continue;
    }
    const std::string writer(topic->writer);
    auto member = std::find_if(members.begin(), members.end(), [&](const auto& one) { return one.first == writer; });
    if (member == members.end()) member = members.insert(member, {writer, {}});
    member->second.push_back(topic);
  }
  if (place.own_plant)
    factories.push_back({kStandPlant, [of_plant, &place, &board](Wiring& wiring, const Setup&) {
                           return std::make_unique<StandPlant>(StandPorts(wiring, of_plant, place.observes, board),
                                                               board);
                         }});
  for (const auto& [name, writes] : members) {
    const bool leads = factories.empty();
    factories.push_back(
        {name, [writes = writes, leads, &place, &board](Wiring& wiring, const Setup&) {
           return std::make_unique<StandMember>(
               StandPorts(wiring, writes, leads ? place.observes : std::vector<const TopicInfo*>{}, board), board,
               leads);
         }});
  }
  return factories;
}

}  // namespace constrictor::conform
