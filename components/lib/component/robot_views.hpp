// Groups of inputs that several components read together.
#pragma once

#include "component/ports.hpp"

namespace constrictor {

/// The measurements of the robot's body.
struct BodyView {
  explicit BodyView(Wiring& wiring)
      : joints(wiring.latest(topics::kJointState)), contacts(wiring.latest(topics::kContactState)) {}
  Latest<msg::JointState> joints;
  Latest<msg::ContactState> contacts;
};

/// The percepts of the newest image.
struct PerceptView {
  explicit PerceptView(Wiring& wiring)
      : line(wiring.latest(topics::kLinePercept)), objects(wiring.latest(topics::kObjectPercepts)) {}
  Latest<msg::LinePercept> line;
  Latest<msg::ObjectPercepts> objects;
};

/// The percepts of the newest images of the further cameras.
struct FurtherPerceptView {
  explicit FurtherPerceptView(Wiring& wiring)
      : lines(wiring.events(topics::kFurtherLinePercept)), objects(wiring.events(topics::kFurtherObjectPercepts)) {}
  Events<msg::LinePercept> lines;
  Events<msg::ObjectPercepts> objects;
};

/// The robot's estimate of the field around it: the percepts, its own pose, and the map.
struct FieldView : PerceptView {
  explicit FieldView(Wiring& wiring)
      : PerceptView(wiring), pose(wiring.latest(topics::kRobotPose)), map(wiring.latest(topics::kFieldMap)) {}
  Latest<msg::RobotPose> pose;
  Latest<msg::FieldMap> map;
};

}  // namespace constrictor
