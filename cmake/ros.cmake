# Messages, the ROS library, node and nodelet, and what is installed beside them.
file(GLOB CURTAIN_MESSAGES RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/msg CONFIGURE_DEPENDS msg/*.msg)
add_message_files(DIRECTORY msg FILES ${CURTAIN_MESSAGES})
generate_messages(DEPENDENCIES std_msgs geometry_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES curtain_engine
  CATKIN_DEPENDS roscpp message_runtime nodelet std_msgs geometry_msgs visualization_msgs)

file(GLOB CURTAIN_ROS_SOURCES CONFIGURE_DEPENDS src/ros/*.cpp)
add_library(curtain_ros ${CURTAIN_ROS_SOURCES})
add_dependencies(curtain_ros ${curtain_sim_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
target_include_directories(curtain_ros PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_include_directories(curtain_ros SYSTEM PUBLIC ${CATKIN_DEVEL_PREFIX}/include ${catkin_INCLUDE_DIRS})
target_link_libraries(curtain_ros PUBLIC curtain_engine ${catkin_LIBRARIES} PRIVATE curtain_warnings)

add_executable(curtain_node src/curtain_node.cpp)
target_link_libraries(curtain_node PRIVATE curtain_ros curtain_warnings)

add_library(curtain_nodelet MODULE src/curtain_nodelet.cpp)
target_link_libraries(curtain_nodelet PRIVATE curtain_ros curtain_warnings)

# Where rosrun and rostest look in the devel space. The engine's targets are older than catkin_package(), which
# sets this for those that follow it.
set_target_properties(curtain_batch PROPERTIES
  RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
set_target_properties(curtain_engine PROPERTIES
  ARCHIVE_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_LIB_DESTINATION})

install(TARGETS curtain_engine curtain_ros curtain_nodelet
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(TARGETS curtain_node curtain_batch RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
catkin_install_python(PROGRAMS scripts/demo_motion scripts/live_figures DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY include/curtain_sim/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
install(DIRECTORY launch config DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
