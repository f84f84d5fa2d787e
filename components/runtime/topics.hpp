// The table of topics: the one place from which ports, DDS entities, the barrier's manifest, documentation and tools derive
// name, type, writer, depth and rate of each topic.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Facts about one member topic that do not depend on its message type.
struct TopicInfo {
  std::uint8_t id;                ///< index in Tick.visible
  std::string_view name;          ///< DDS topic name
  std::string_view type;          ///< IDL type
  std::string_view writer;        ///< the one component that writes it
  std::uint8_t max_per_tick;      ///< most samples a step of the writer may write
  std::uint16_t depth;            ///< history kept for readers and restarted readers
  bool simulation_only;           ///< ground truth: no component of components/ may read it
  std::string_view rate;          ///< for people
  std::string_view doc;
};

/// A topic with its message type; ports are made from it.
template <class Message>
struct Topic : TopicInfo {
  using message_type = Message;
};

namespace topics {

// depth >= (latency of the writer + longest reader period + 1) * max_per_tick
inline constexpr Topic<msg::JointState> kJointState{
    {0, "joint_state", "JointState", "physics", 1, 8, false, "every tick", "measured joints"}};
inline constexpr Topic<msg::ContactState> kContactState{
    {1, "contact_state", "ContactState", "physics", 1, 8, false, "every tick", "the skin"}};
inline constexpr Topic<msg::ImuState> kImuState{
    {2, "imu_state", "ImuState", "physics", 1, 8, false, "every tick", "inertial unit in the head"}};
inline constexpr Topic<msg::SceneDescription> kSceneDescription{
    {3, "simulation/scene", "SceneDescription", "physics", 1, 1, true, "once an epoch", "what does not move"}};
inline constexpr Topic<msg::WorldState> kWorldState{
    {4, "simulation/world_state", "WorldState", "physics", 1, 32, true, "every tick", "ground truth"}};
inline constexpr Topic<msg::TouchedState> kTouchedState{
    {5, "simulation/touched", "TouchedState", "physics", 1, 8, true, "every tick", "what each contact touched"}};
inline constexpr Topic<msg::CameraInfo> kCameraInfo{
    {6, "camera/info", "CameraInfo", "camera", 1, 1, false, "once an epoch", "camera model and mount"}};
inline constexpr Topic<msg::CameraImage> kCameraImage{
    {7, "camera/image", "CameraImage", "camera", 1, 2, false, "every camera period", "raw image"}};
inline constexpr Topic<msg::CameraImage> kOverviewImage{
    {8, "overview/image", "CameraImage", "overview", 1, 2, true, "every overview period", "picture of the scene"}};
inline constexpr Topic<msg::LinePercept> kLinePercept{
    {9, "perception/line", "LinePercept", "perception", 1, 8, false, "every image", "the line in view"}};
inline constexpr Topic<msg::ObjectPercepts> kObjectPercepts{
    {10, "perception/objects", "ObjectPercepts", "perception", 1, 8, false, "every image", "objects and zones in view"}};
inline constexpr Topic<msg::CameraImage> kProcessedImage{
    {11, "perception/image", "CameraImage", "perception", 1, 2, false, "every image", "what perception found"}};
inline constexpr Topic<msg::RobotPose> kRobotPose{
    {12, "guidance/pose", "RobotPose", "guidance", 1, 8, false, "every tick", "estimated head pose"}};
inline constexpr Topic<msg::FieldMap> kFieldMap{
    {13, "guidance/map", "FieldMap", "guidance", 1, 8, false, "every 5 ticks", "line, objects, zones, what was felt"}};
inline constexpr Topic<msg::TaskCommand> kTaskCommand{
    {14, "task/command", "TaskCommand", "input", 4, 32, false, "on demand", "start or cancel a task"}};
inline constexpr Topic<msg::Authority> kAuthority{
    {15, "authority", "Authority", "input", 1, 8, false, "on change, every 50 ticks", "who commands"}};
inline constexpr Topic<msg::TaskStatus> kTaskStatus{
    {16, "task/status", "TaskStatus", "navigation", 1, 8, false, "every tick", "current goal"}};
inline constexpr Topic<msg::TaskEvent> kTaskEvent{
    {17, "task/event", "TaskEvent", "navigation", 16, 1024, false, "on occurrence", "events of Tables I to XV"}};
inline constexpr Topic<msg::DesiredTrajectory> kDesiredTrajectory{
    {18, "desired_trajectory", "DesiredTrajectory", "navigation", 1, 8, false, "every tick", "path, velocity, posture"}};
inline constexpr Topic<msg::MotionStatus> kMotionStatus{
    {19, "motion_status", "MotionStatus", "control", 1, 8, false, "every tick", "progress of a motion"}};
inline constexpr Topic<msg::JointCommand> kJointCommand{
    {20, "joint_command", "JointCommand", "control", 1, 8, false, "every tick", "servo setpoints"}};
inline constexpr Topic<msg::Request> kPlannerRequest{
    {21, "planner/request", "Request", "planner", 4, 32, false, "on demand", "the built-in planner's wishes"}};
inline constexpr Topic<msg::MissionStatus> kMissionStatus{
    {22, "mission_status", "MissionStatus", "planner", 1, 8, false, "every tick", "state machine of Fig. 3"}};
inline constexpr Topic<msg::MotionCommand> kMotionCommand{
    {23, "motion/command", "MotionCommand", "input", 1, 8, false, "on demand", "direct motion"}};
inline constexpr Topic<msg::ParameterChange> kParameterChange{
    {24, "parameter/change", "ParameterChange", "input", 8, 64, false, "on demand", "a parameter's new value"}};
inline constexpr Topic<msg::ParameterList> kNavigationParameters{
    {25, "parameter/navigation", "ParameterList", "navigation", 1, 8, false, "at the start, on change", "run-time parameters of navigation"}};
inline constexpr Topic<msg::ParameterList> kControlParameters{
    {26, "parameter/control", "ParameterList", "control", 1, 8, false, "at the start, on change", "run-time parameters of control"}};
inline constexpr Topic<msg::ParameterList> kPerceptionParameters{
    {27, "parameter/perception", "ParameterList", "perception", 1, 8, false, "at the start, on change", "run-time parameters of perception"}};
inline constexpr Topic<msg::ParameterList> kGuidanceParameters{
    {28, "parameter/guidance", "ParameterList", "guidance", 1, 8, false, "at the start, on change", "run-time parameters of guidance"}};
inline constexpr Topic<msg::RequestAnswer> kRequestAnswer{
    {29, "request/answer", "RequestAnswer", "input", 96, 288, false, "on demand", "granted or refused, request by request"}};

/// Every member topic, by id.
inline constexpr auto kAll = std::make_tuple(
    kJointState, kContactState, kImuState, kSceneDescription, kWorldState, kTouchedState, kCameraInfo, kCameraImage,
    kOverviewImage, kLinePercept, kObjectPercepts, kProcessedImage, kRobotPose, kFieldMap, kTaskCommand, kAuthority,
    kTaskStatus, kTaskEvent, kDesiredTrajectory, kMotionStatus, kJointCommand, kPlannerRequest, kMissionStatus,
    kMotionCommand, kParameterChange, kNavigationParameters, kControlParameters, kPerceptionParameters, kGuidanceParameters,
    kRequestAnswer);
inline constexpr std::size_t kCount = std::tuple_size_v<decltype(kAll)>;
static_assert(kCount <= msg::kMaxTopics);

/// The table without types, for tools and messages to people.
inline constexpr std::array<TopicInfo, kCount> kInfos =
    std::apply([](const auto&... topic) { return std::array<TopicInfo, kCount>{TopicInfo(topic)...}; }, kAll);

}  // namespace topics
}  // namespace constrictor
