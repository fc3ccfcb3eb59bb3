// SPDX-License-Identifier: BSD-3-Clause
//
// Sends wind sources, drag forces, or both in turn, as fast as it is told. Usage:
//
//   curtain_flood KIND COUNT RATE SEED    messages, 1/s (0: as fast as they go)
//
//   same   the same fan again and again
//   valid  any values that are allowed, of any of 400 ids, added, changed, deleted
//   wild   any bits at all in every number: NaN, infinities, denormals, huge, negative
//
// Prints "sent COUNT" when the last one is queued, and stays until it is interrupted, so that none is lost with it.
#include <curtain_sim/DragForce.h>
#include <curtain_sim/WindSource.h>
#include <ros/ros.h>

#include <cstring>
#include <iostream>
#include <random>
#include <string>

namespace {

using curtain_sim::DragForce;
using curtain_sim::WindSource;

constexpr int kRows = 10;
constexpr int kColumns = 8;

class Sender {
 public:
  Sender(const std::string& kind, unsigned seed) : kind_(kind), random_(seed) {}

  WindSource wind() {
    WindSource message;
    message.id = "fan";
    message.pose.position.x = 0.35;
    message.pose.position.y = -1.0;
    message.pose.position.z = 1.5;
    message.pose.orientation.z = message.pose.orientation.w = std::sqrt(0.5);
    message.radius = 1.0;
    message.pressure = 2.0;
    if (kind_ == "same") return message;
    message.id = "w" + std::to_string(integer(0, 399));
    message.action = action<WindSource>();
    message.header.frame_id = integer(0, 1) == 0 ? "" : "world";
    for (double* p : {&message.pose.position.x, &message.pose.position.y, &message.pose.position.z})
      *p = number(-5.0, 5.0);
    auto& q = message.pose.orientation;
    for (double* p : {&q.x, &q.y, &q.z, &q.w}) *p = number(0.1, 1.0);
    message.radius = number(0.01, 3.0);
    message.half_angle = number(0.0, 1.5);
    message.pressure = number(0.0, 20.0);
    message.unsteadiness = number(0.0, 5.0);
    message.correlation_time = number(1e-6, 10.0);
    message.lifetime = number(0.0, 0.5);
    return message;
  }

  DragForce drag() {
    DragForce message;
    message.id = "d" + std::to_string(integer(0, 399));
    message.action = action<DragForce>();
    const bool by_point = integer(0, 1) == 0;
    message.row = by_point ? -1 : integer(0, kRows - 1);
    message.column = by_point ? -1 : integer(0, kColumns - 1);
    if (kind_ == "wild" && !by_point) message.row = integer(-3, kRows + 3);
    for (double* p : {&message.point.x, &message.point.y, &message.point.z}) *p = number(-2.0, 2.0);
    message.mode = static_cast<std::uint8_t>(integer(0, kind_ == "wild" ? 3 : 1));
    for (double* p : {&message.force.x, &message.force.y, &message.force.z}) *p = number(-1.0, 1.0);
    for (double* p : {&message.target.x, &message.target.y, &message.target.z}) *p = number(-2.0, 2.0);
    message.stiffness = number(0.0, 200.0);
    message.radius = number(0.0, 0.5);
    message.lifetime = number(0.01, 0.5);
    return message;
  }

 private:
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  // In the range; wild: half of them any bits.
  double number(double low, double high) {
    if (kind_ == "wild" && integer(0, 1) == 0) {
      const std::uint64_t bits = random_();
      double any = 0.0;
      std::memcpy(&any, &bits, sizeof any);
      return any;
    }
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  template <typename Message>
  std::uint8_t action() {
    const int which = integer(0, 99);
    if (kind_ == "wild" && which > 95) return static_cast<std::uint8_t>(integer(0, 255));
    return which < 5 ? Message::DELETE : which == 5 ? Message::DELETEALL : Message::ADD;
  }

  std::string kind_;
  std::mt19937_64 random_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "curtain_flood", ros::init_options::AnonymousName);
  if (argc != 5) {
    std::cerr << "usage: curtain_flood same|valid|wild COUNT RATE SEED\n";
    return 2;
  }
  const std::string kind = argv[1];
  const long count = std::stol(argv[2]);
  const double rate = std::stod(argv[3]);
  Sender sender(kind, static_cast<unsigned>(std::stoul(argv[4])));
  ros::NodeHandle node;
  ros::Publisher winds = node.advertise<WindSource>("wind_source", 0);  // 0: as many as there are, none dropped here
  ros::Publisher drags = node.advertise<DragForce>("drag_force", 0);
  while (ros::ok() && (winds.getNumSubscribers() == 0 || drags.getNumSubscribers() == 0))
    ros::WallDuration(0.01).sleep();

  const ros::SteadyTime start = ros::SteadyTime::now();
  for (long sent = 0; sent < count && ros::ok(); ++sent) {
    if (rate > 0.0) {
      const double ahead = static_cast<double>(sent) / rate - (ros::SteadyTime::now() - start).toSec();
      if (ahead > 1e-3) ros::WallDuration(ahead).sleep();
    }
    if (kind == "same" || sent % 2 == 0) {
      winds.publish(sender.wind());
    } else {
      drags.publish(sender.drag());
    }
  }
  std::cout << "sent " << count << std::endl;
  ros::spin();
  return 0;
}
