// ros_probe: acts as a ROS 2 node on another vendor's DDS with ROS's topic and type names. It prints a line for each
// sample, and for each reader and writer that it discovers. With --drive it writes velocities, as teleop_twist_keyboard
// does; with --task, --stop and --clear it requests a task, an emergency stop or the end of the stop, until the bridge
// has answered: the first sample of a new writer may be lost, because its reader has not discovered it yet.
//   ros_probe --domain N --for SECONDS [--drive SPEED,TURN] [--task LINE] [--stop] [--clear] [--humble]
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "participant.hpp"
#include "ros_typesPubSubTypes.h"

namespace {

namespace rtps = eprosima::fastrtps::rtps;

volatile std::sig_atomic_t g_stop = 0;

template <class Stamp>
long long ns(const Stamp& stamp) {
  return stamp.sec() * 1'000'000'000LL + stamp.nanosec();
}

std::string hexadecimal(const std::uint8_t* bytes, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", bytes[i]);
    text += digits;
  }
  return text;
}

std::string hexadecimal(const rtps::GUID_t& guid) {
  return hexadecimal(guid.guidPrefix.value, 12) + hexadecimal(guid.entityId.value, 4);
}

/// Prints "participant GUID USERDATA", "writer TOPIC GUID USERDATA" and "reader ..." of what Fast DDS discovers.
class Discovery : public example::fdds::DomainParticipantListener {
 public:
  void on_participant_discovery(example::fdds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& found) override {
    if (found.status != rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT) return;
    const auto& data = found.info.m_userData;
    std::printf("participant %s %s\n", hexadecimal(found.info.m_guid).c_str(),
                std::string(data.begin(), data.end()).c_str());
  }
  void on_publisher_discovery(example::fdds::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) override {
    if (found.status == rtps::WriterDiscoveryInfo::DISCOVERED_WRITER) print("writer", found.info);
  }
  void on_subscriber_discovery(example::fdds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& found) override {
    if (found.status == rtps::ReaderDiscoveryInfo::DISCOVERED_READER) print("reader", found.info);
  }

 private:
  template <class Info>
  static void print(const char* kind, const Info& info) {
    const auto& data = info.m_qos.m_userData;
    std::printf("%s %s %s %s\n", kind, info.topicName().c_str(), hexadecimal(info.guid()).c_str(),
                std::string(data.begin(), data.end()).c_str());
  }
};

/// Prints "node PARTICIPANT NAMESPACE NAME", then a line for each of its entities, as `ros2 node info` would.
template <class Graph>
void print_graph(const Graph& graph) {
  const auto gid = [](const auto& id) { return hexadecimal(id.data().data(), id.data().size()); };
  for (const auto& node : graph.node_entities_info_seq()) {
    std::printf("node %s %s %s\n", gid(graph.gid()).c_str(), node.node_namespace().c_str(), node.node_name().c_str());
    for (const auto& id : node.writer_gid_seq()) std::printf("node_writer %s\n", gid(id).c_str());
    for (const auto& id : node.reader_gid_seq()) std::printf("node_reader %s\n", gid(id).c_str());
  }
}

/// Humble's message has the name of the later ones, which generated code cannot express.
class HumbleGraph : public rmw_dds_common::msg::dds_::HumbleParticipantEntitiesInfo_PubSubType {
 public:
  HumbleGraph() { setName("rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"); }
};

/// What the bridge has answered to this program's requests.
struct Answers {
  std::string task;  ///< the line that was requested
  bool task_answered = false, stopped = false;
};

void read_surroundings(example::Participant& node, Answers& answers) {
  const auto print_markers = [](const char* name) {
    return [name](const visualization_msgs::msg::dds_::MarkerArray_& m) {
      std::printf("%s %zu", name, m.markers().size());
      for (const auto& marker : m.markers())
        std::printf(" %s:%d:%d:%zu", marker.ns().c_str(), marker.id(), marker.type(), marker.points().size());
      std::printf("\n");
    };
  };
  using Markers = visualization_msgs::msg::dds_::MarkerArray_PubSubType;
  node.read<Markers>("rt/markers/map", true, 1, print_markers("markers/map"));
  node.read<Markers>("rt/markers/line_in_view", true, 1, print_markers("markers/line_in_view"));
  node.read<Markers>("rt/markers/objects_in_view", true, 1, print_markers("markers/objects_in_view"));
  using Path = nav_msgs::msg::dds_::Path_PubSubType;
  node.read<Path>("rt/line", true, 1,
                  [](const auto& m) { std::printf("line %s %zu\n", m.header().frame_id().c_str(), m.poses().size()); });
  node.read<Path>("rt/plan", true, 1,
                  [](const auto& m) { std::printf("plan %s %zu\n", m.header().frame_id().c_str(), m.poses().size()); });
  node.read<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>("rt/diagnostics", true, 1, [](const auto& m) {
    for (const auto& status : m.status())
      std::printf("diagnostics %d %s %s\n", int{status.level()}, status.name().c_str(), status.message().c_str());
  });
  using Text = std_msgs::msg::dds_::String_PubSubType;
  node.read<Text>("rt/task/answer", true, 64, [&answers](const auto& m) {
    std::printf("task/answer %s\n", m.data().c_str());
    answers.task_answered |= m.data().find("\"" + answers.task + "\"") != std::string::npos;
  });
  for (const char* name : {"task/status", "task/event"})
    node.read<Text>(std::string("rt/") + name, true, 64,
                    [name](const auto& m) { std::printf("%s %s\n", name, m.data().c_str()); });
  node.read<Text>("rt/robot_description", true, 1,
                  [](const auto& m) { std::printf("robot_description %zu\n%s", m.data().size(), m.data().c_str()); });
  node.read<rcl_interfaces::msg::dds_::Log_PubSubType>("rt/rosout", true, 256, [](const auto& m) {
    std::printf("rosout %d %s %s\n", int{m.level()}, m.name().c_str(), m.msg().c_str());
  });
  node.read<std_msgs::msg::dds_::Bool_PubSubType>("rt/emergency_stop/state", true, 1, [&answers](const auto& m) {
    answers.stopped = m.data();
    std::printf("stopped %s\n", m.data() ? "true" : "false");
  });
}

void read_robot(example::Participant& node) {
  namespace sensor = sensor_msgs::msg::dds_;
  node.read<rosgraph_msgs::msg::dds_::Clock_PubSubType>(
      "rt/clock", false, 10, [](const auto& m) { std::printf("clock %lld\n", ns(m.clock())); });
  node.read<sensor::JointState_PubSubType>("rt/joint_states", false, 10, [](const auto& m) {
    std::printf("joint_states %lld", ns(m.header().stamp()));
    for (std::size_t i = 0; i < m.name().size(); ++i) std::printf(" %s=%.17g", m.name()[i].c_str(), m.position().at(i));
    std::printf("\n");
  });
  node.read<sensor::Imu_PubSubType>("rt/imu", false, 10, [](const auto& m) {
    std::printf("imu %lld %s %.17g\n", ns(m.header().stamp()), m.header().frame_id().c_str(),
                m.linear_acceleration().z());
  });
  node.read<nav_msgs::msg::dds_::Odometry_PubSubType>("rt/odom", false, 10, [](const auto& m) {
    std::printf("odom %lld %s %s %.17g %.17g\n", ns(m.header().stamp()), m.header().frame_id().c_str(),
                m.child_frame_id().c_str(), m.pose().pose().position().x(), m.pose().pose().position().y());
  });
  const auto print_tf = [](const char* name) {
    return [name](const tf2_msgs::msg::dds_::TFMessage_& m) {
      std::printf("%s", name);
      for (const auto& t : m.transforms())
        std::printf(" %s>%s", t.header().frame_id().c_str(), t.child_frame_id().c_str());
      std::printf("\n");
    };
  };
  node.read<tf2_msgs::msg::dds_::TFMessage_PubSubType>("rt/tf", false, 10, print_tf("tf"));
  node.read<tf2_msgs::msg::dds_::TFMessage_PubSubType>("rt/tf_static", true, 10, print_tf("tf_static"));
  const auto print_image = [](const char* name) {
    return [name](const sensor::Image_& m) {
      unsigned long sum = 0;
      for (const auto byte : m.data()) sum += byte;
      std::printf("%s %lld %ux%u %s %zu %lu\n", name, ns(m.header().stamp()), m.width(), m.height(),
                  m.encoding().c_str(), m.data().size(), sum);
    };
  };
  // ROS 2's default depth. With 2, an image of which datagrams are asked for again is pushed out by the next two
  // images.
  node.read<sensor::Image_PubSubType>("rt/camera/image_raw", true, 10, print_image("image"));
  node.read<sensor::Image_PubSubType>("rt/perception/image", true, 10, print_image("percept_image"));
  node.read<sensor::CameraInfo_PubSubType>("rt/camera/camera_info", true, 10, [](const auto& m) {
    std::printf("camera_info %lld %ux%u %s fx=%.6f\n", ns(m.header().stamp()), m.width(), m.height(),
                m.distortion_model().c_str(), m.k()[0]);
  });
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  unsigned domain = 0;
  double seconds = 5, speed_m_s = 0, turn_rad_s = 0;
  bool drive = false, stop = false, clear = false, humble = false;
  Answers answers;
  for (int i = 1; i < argc; ++i) {
    stop = stop || !std::strcmp(argv[i], "--stop");
    clear = clear || !std::strcmp(argv[i], "--clear");
    humble = humble || !std::strcmp(argv[i], "--humble");
    if (i + 1 == argc) break;
    if (!std::strcmp(argv[i], "--domain")) domain = static_cast<unsigned>(std::atoi(argv[i + 1]));
    if (!std::strcmp(argv[i], "--for")) seconds = std::atof(argv[i + 1]);
    if (!std::strcmp(argv[i], "--task")) answers.task = argv[i + 1];
    if (!std::strcmp(argv[i], "--drive")) drive = std::sscanf(argv[i + 1], "%lf,%lf", &speed_m_s, &turn_rad_s) == 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 1 << 16);  // whole lines, from the threads of Fast DDS as well
  Discovery discovery;
  example::Participant node(domain, "ros_probe", "127.0.0.1", &discovery);
  if (humble) node.read<HumbleGraph>("ros_discovery_info", true, 1, [](const auto& m) { print_graph(m); });
  else
    node.read<rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_PubSubType>("ros_discovery_info", true, 1,
                                                                             [](const auto& m) { print_graph(m); });
  read_robot(node);
  read_surroundings(node, answers);
  auto* velocity = drive ? node.write<geometry_msgs::msg::dds_::Twist_PubSubType>("rt/cmd_vel", 1, false) : nullptr;
  auto* tasks =
      answers.task.empty() ? nullptr : node.write<std_msgs::msg::dds_::String_PubSubType>("rt/task/request", 1, false);
  using Empty = std_msgs::msg::dds_::Empty_PubSubType;
  auto* stops = stop ? node.write<Empty>("rt/emergency_stop", 1, false) : nullptr;

  auto* clears = clear ? node.write<Empty>("rt/emergency_stop/clear", 1, false) : nullptr;

  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  auto next_request = Clock::now();
  for (auto next = Clock::now(); !g_stop && Clock::now() < end;) {
    node.wait(0.05);
    if (Clock::now() >= next_request) {
      next_request = Clock::now() + std::chrono::seconds(1);
      std_msgs::msg::dds_::String_ line;
      line.data(answers.task);
      if (tasks && !answers.task_answered) tasks->write(&line);
      std_msgs::msg::dds_::Empty_ empty;
      if (stops && !answers.stopped) stops->write(&empty);
      if (clears && answers.stopped) clears->write(&empty);
    }
    if (!velocity || Clock::now() < next) continue;
    next = Clock::now() + std::chrono::milliseconds(100);
    geometry_msgs::msg::dds_::Twist_ twist;
    twist.linear().x(speed_m_s);
    twist.angular().z(turn_rad_s);
    velocity->write(&twist);
  }
}
