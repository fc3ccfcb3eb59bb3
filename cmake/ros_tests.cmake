# Unit tests of the ROS floor, rostests and launch file checks.
find_package(rostest REQUIRED)
