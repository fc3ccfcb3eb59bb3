// SPDX-License-Identifier: BSD-3-Clause
#include "export/play_bag.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "curtain_sim/CurtainState.h"
#include "rviz/surface/curtain_surface.h"
#include "rviz/surface/state_check.h"

namespace curtain {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

std::invalid_argument problem(const std::string& path, const std::string& text) {
  return std::invalid_argument(path + ": " + text);
}

std::set<std::string> topicsOf(const rosbag::Bag& bag, const std::string& type) {
  std::set<std::string> topics;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
    if (connection->datatype == type) topics.insert(connection->topic);
  }
  return topics;
}

std::string stateTopic(const std::string& path, const rosbag::Bag& bag, const std::string& wanted) {
  const std::set<std::string> topics = topicsOf(bag, ros::message_traits::datatype<curtain_sim::CurtainState>());
  std::string list;
  for (const std::string& topic : topics) list += " " + topic;
  if (topics.empty()) throw problem(path, "has no curtain_sim/CurtainState in it");
  if (!wanted.empty() && topics.count(wanted) == 0)
    throw problem(path, "has no states on " + wanted + "; there are:" + list);
  if (wanted.empty() && topics.size() > 1)
    throw problem(path, "has states of several curtains, choose by --topic:" + list);
  return wanted.empty() ? *topics.begin() : wanted;
}

std::string markersTopic(const std::string& states) { return states.substr(0, states.rfind('/')) + "/markers"; }

Vec3 meanColour(const Marker& marker) {
  Vec3 sum = Vec3::Zero();
  for (const std_msgs::ColorRGBA& c : marker.colors) sum += Vec3(c.r, c.g, c.b);
  const Vec3 mean = marker.colors.empty() ? Vec3(marker.color.r, marker.color.g, marker.color.b)
                                          : Vec3(sum / static_cast<double>(marker.colors.size()));
  return mean.cwiseMax(0.0).cwiseMin(1.0);
}

// Corners at one place are one corner: which faces share their normals is seen by that.
ShapeTriangles shapeOf(const Marker& marker) {
  ShapeTriangles shape;
  std::map<std::array<double, 3>, int> known;
  std::vector<int> corners;
  for (const geometry_msgs::Point& p : marker.points) {
    const auto [place, is_new] = known.try_emplace({p.x, p.y, p.z}, static_cast<int>(shape.corners.size()));
    if (is_new) shape.corners.emplace_back(p.x, p.y, p.z);
    corners.push_back(place->second);
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    shape.triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
  return shape;
}

bool isSound(const Marker& marker) {
  const auto finite = [](const geometry_msgs::Point& p) { return Vec3(p.x, p.y, p.z).allFinite(); };
  const geometry_msgs::Quaternion& q = marker.pose.orientation;
  const double norm = Eigen::Vector4d(q.x, q.y, q.z, q.w).norm();
  return finite(marker.pose.position) && norm > 0.5 && norm < 2.0 && marker.points.size() % 3 == 0 &&
         std::all_of(marker.points.begin(), marker.points.end(), finite);
}

Pose poseOf(const Marker& marker) {
  const geometry_msgs::Point& p = marker.pose.position;
  const geometry_msgs::Quaternion& q = marker.pose.orientation;
  return {Vec3(p.x, p.y, p.z), Rotation(q.w, q.x, q.y, q.z).normalized()};
}

/// What a bag has, message by message.
class BagPlayer {
 public:
  BagPlayer(const std::string& path, const Excerpt& excerpt, AnimationWriter& writer)
      : path_(path), excerpt_(excerpt), writer_(writer), ticks_(excerpt.rate) {}

  /// Returns whether the animation goes on.
  bool play(const rosbag::MessageInstance& message) {
    if (message.isType<MarkerArray>()) {
      addMarkers(read<MarkerArray>(message));
      return true;  // states of an earlier time may follow
    }
    return isBeforeEnd(addState(read<curtain_sim::CurtainState>(message)));
  }

  bool hasFrames() const { return has_frames_; }

 private:
  template <class Message>
  typename Message::ConstPtr read(const rosbag::MessageInstance& message) const {
    const typename Message::ConstPtr content = message.instantiate<Message>();
    if (!content)
      throw problem(path_,
                    message.getTopic() + " has " + message.getDataType() + " of another version of this package");
    return content;
  }

  // From the first state on [s]. ros::Duration ends at 68 years.
  double timeOf(const ros::Time& stamp) const {
    return static_cast<double>(static_cast<std::int64_t>(stamp.toNSec()) -
                               static_cast<std::int64_t>(origin_->toNSec())) /
           1e9;
  }

  bool isBeforeEnd(double time) const { return !excerpt_.end || time <= *excerpt_.end; }

  double addState(const curtain_sim::CurtainState::ConstPtr& state) {
    const std::string wrong = curtain_rviz::whatIsWrong(*state);
    if (!origin_) origin_ = state->header.stamp;
    const double time = timeOf(state->header.stamp);
    const std::string when = "at " + std::to_string(time) + " s ";
    if (!wrong.empty()) throw problem(path_, when + wrong);
    if (last_ && time < *last_)
      throw problem(path_, when + "its clock jumps back, by " + std::to_string(*last_ - time) +
                               " s; divide it there, by rosbag filter");
    last_ = time;
    if (time < excerpt_.start || !isBeforeEnd(time)) return time;
    if (!begin_) begin_ = time;
    if (!ticks_.reach(time - *begin_))
      throw problem(path_, when + "its clock has jumped ahead, by more frames than can be counted; end before that");
    const int due = ticks_.advance(time - *begin_);
    if (due == 0) return time;
    const bool is_new = surface_.update(*state);
    if (is_new && has_frames_) throw problem(path_, when + "it is another cloth; end before that, or start there");
    if (is_new) writer_.setCloth(surface_.triangles(), surface_.coordinates());
    has_frames_ = true;
    vertices_.clear();
    for (const curtain_rviz::SurfaceVertex& vertex : surface_.vertices())
      vertices_.push_back({vertex.position, vertex.normal});
    writer_.addFrame(time - *begin_, vertices_, due);
    return time;
  }

  // Where bodies were before the animation counts as its start.
  void addMarkers(const MarkerArray::ConstPtr& array) {
    for (const Marker& marker : array->markers) {
      if (marker.ns != "obstacles" || marker.type != Marker::TRIANGLE_LIST || marker.points.empty()) continue;
      const std::string name = "obstacle " + std::to_string(marker.id);
      if (!isSound(marker))
        throw problem(path_, name + ": a number of its marker is not finite, or a corner is missing");
      const double time = begin_ ? timeOf(marker.header.stamp) - *begin_ : 0.0;
      if (begin_ && !isBeforeEnd(timeOf(marker.header.stamp))) continue;
      const auto [body, is_new] = bodies_.try_emplace(marker.id, 0);
      if (is_new) body->second = writer_.addBody({name, meanColour(marker), shapeOf(marker)});
      writer_.addPose(body->second, std::max(time, 0.0), poseOf(marker), marker.action == Marker::ADD);
    }
  }

  const std::string& path_;
  const Excerpt& excerpt_;
  AnimationWriter& writer_;
  Ticks ticks_;
  std::optional<ros::Time> origin_;
  std::optional<double> begin_, last_;  // of the animation; of the last state [s]
  bool has_frames_ = false;
  curtain_rviz::CurtainSurface surface_;
  std::vector<AnimatedVertex> vertices_;
  std::map<int, std::size_t> bodies_;  // by the markers' ids
};

}  // namespace

void playBag(const std::string& path, const std::string& topic, const Excerpt& excerpt, AnimationWriter& writer) {
  if (!std::filesystem::is_regular_file(path)) throw problem(path, "there is no such file");
  try {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    const std::string states = stateTopic(path, bag, topic);
    BagPlayer player(path, excerpt, writer);
    rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{states, markersTopic(states)}));
    for (const rosbag::MessageInstance& message : view) {
      if (!player.play(message)) break;
    }
    if (!player.hasFrames()) throw problem(path, "has no state of " + states + " in the part asked for");
  } catch (const rosbag::BagUnindexedException&) {
    throw problem(path, "has no index, its recording was cut off: rosbag reindex makes one");
  } catch (const ros::Exception& error) {  // of rosbag, or of a message that ends too early
    throw problem(path, std::string("can't be read as a bag: ") + error.what());
  }
}

}  // namespace curtain
