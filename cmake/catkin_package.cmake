# Messages, and what packages that depend on this one get: them, and the target curtain_sim::engine in catkin_LIBRARIES.
file(GLOB CURTAIN_MESSAGES RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/msg CONFIGURE_DEPENDS msg/*.msg)
add_message_files(DIRECTORY msg FILES ${CURTAIN_MESSAGES})
add_service_files(DIRECTORY srv FILES Attach.srv Detach.srv Distance.srv ExportMesh.srv Load.srv Save.srv SetMaterial.srv Step.srv TieBack.srv)
add_action_files(DIRECTORY action FILES Grasp.action OpenCurtain.action)
generate_messages(DEPENDENCIES std_msgs geometry_msgs actionlib_msgs)
generate_dynamic_reconfigure_options(cfg/Curtain.cfg)

catkin_package(
  INCLUDE_DIRS include
  CATKIN_DEPENDS message_runtime std_msgs geometry_msgs actionlib_msgs dynamic_reconfigure
  DEPENDS EIGEN3
  CFG_EXTRAS curtain_sim-engine.cmake)
