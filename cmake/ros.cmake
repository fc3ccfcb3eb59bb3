include(cmake/sensing.cmake)

# The ROS library, node and nodelet.
file(GLOB CURTAIN_ROS_SOURCES CONFIGURE_DEPENDS src/ros/*.cpp src/ros/*/*.cpp)
add_library(curtain_ros STATIC ${CURTAIN_ROS_SOURCES})
add_dependencies(curtain_ros ${curtain_sim_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
target_include_directories(curtain_ros PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_include_directories(curtain_ros SYSTEM PUBLIC ${CATKIN_DEVEL_PREFIX}/include ${catkin_INCLUDE_DIRS})
target_link_libraries(curtain_ros PUBLIC curtain_engine curtain_sensing ${catkin_LIBRARIES} PRIVATE curtain_warnings)

add_executable(curtain_node src/curtain_node.cpp)
target_link_libraries(curtain_node PRIVATE curtain_ros curtain_warnings)

add_library(curtain_nodelet MODULE src/curtain_nodelet.cpp)
target_link_libraries(curtain_nodelet PRIVATE curtain_ros curtain_warnings)

# What a demo runs: the node, its messages and parameters in Python, and rviz's display.
add_custom_target(curtain_demo DEPENDS curtain_node ${PROJECT_NAME}_generate_messages_py ${PROJECT_NAME}_gencfg)
