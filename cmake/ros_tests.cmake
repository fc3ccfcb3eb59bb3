# Unit tests of the ROS floor, rostests and launch file checks.
find_package(rostest REQUIRED)
find_package(roslaunch REQUIRED)

if(curtain_embree)
  curtain_add_tests(sensing curtain_sensing)
endif()
# As where Embree is missing.
curtain_add_tests(sensing_missing)
if(TARGET test_sensing_missing)
  target_sources(test_sensing_missing PRIVATE src/sensing/ray_caster_missing.cpp src/sensing/sensor_params.cpp src/sensing/rays.cpp)
endif()

curtain_add_tests(ros curtain_ros)
if(TARGET test_ros)
  add_dependencies(test_ros ${curtain_sim_EXPORTED_TARGETS})
endif()

curtain_add_tests(rviz curtain_ros curtain_surface)
if(TARGET test_rviz)
  add_dependencies(test_rviz ${curtain_sim_EXPORTED_TARGETS})
endif()

# In C++, with a master.
add_rostest_gtest(test_ros_sharing test/ros/sharing.test test/ros/sharing_master.cpp)
target_link_libraries(test_ros_sharing curtain_ros curtain_warnings)
add_dependencies(test_ros_sharing ${curtain_sim_EXPORTED_TARGETS})

# A sender that is faster and worse than a rospy node.
add_executable(curtain_flood EXCLUDE_FROM_ALL test/ros/flood.cpp)
target_link_libraries(curtain_flood curtain_ros curtain_warnings)
add_dependencies(tests curtain_flood)

# The client of bench/node/step_rate.
add_executable(curtain_step_client EXCLUDE_FROM_ALL bench/node/step_client.cpp)
target_link_libraries(curtain_step_client curtain_ros curtain_warnings)
add_dependencies(tests curtain_step_client)

# Runs other packages' nodelets.
add_executable(curtain_nodelet_host EXCLUDE_FROM_ALL test/ros/nodelet_host.cpp)
target_include_directories(curtain_nodelet_host SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(curtain_nodelet_host ${catkin_LIBRARIES} curtain_warnings)
add_dependencies(tests curtain_nodelet_host)

# Looks at every frame that a node publishes.
add_executable(curtain_judge_frames EXCLUDE_FROM_ALL test/ros/judge_frames.cpp)
target_link_libraries(curtain_judge_frames curtain_ros curtain_warnings)
add_dependencies(curtain_judge_frames ${curtain_sim_EXPORTED_TARGETS})
add_dependencies(tests curtain_judge_frames)

file(GLOB CURTAIN_ROSTESTS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS test/ros/*.test)
list(REMOVE_ITEM CURTAIN_ROSTESTS test/ros/sharing.test)
foreach(file ${CURTAIN_ROSTESTS})
  add_rostest(${file} DEPENDENCIES curtain_node curtain_nodelet curtain_flood curtain_judge_frames curtain_nodelet_host ${curtain_sim_EXPORTED_TARGETS})
endforeach()

if(TARGET curtain_rviz)
  add_dependencies(tests curtain_rviz)
endif()
# Two rviz at a time on a small machine: one of them did not get its window.
foreach(name rviz_display rviz_handle rviz_reopen bags)
  set_tests_properties(_ctest_${PROJECT_NAME}_rostest_test_ros_${name}.test PROPERTIES RESOURCE_LOCK screen)
endforeach()

roslaunch_add_file_check(launch USE_TEST_DEPENDENCIES)
