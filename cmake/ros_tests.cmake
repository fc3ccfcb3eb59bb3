# Unit tests of the ROS floor, rostests and launch file checks.
find_package(rostest REQUIRED)
find_package(roslaunch REQUIRED)

curtain_add_tests(ros curtain_ros)
if(TARGET test_ros)
  add_dependencies(test_ros ${curtain_sim_EXPORTED_TARGETS})
endif()

file(GLOB CURTAIN_ROSTESTS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS test/ros/*.test)
foreach(file ${CURTAIN_ROSTESTS})
  add_rostest(${file} DEPENDENCIES curtain_node curtain_nodelet ${curtain_sim_EXPORTED_TARGETS})
endforeach()

roslaunch_add_file_check(launch USE_TEST_DEPENDENCIES)
