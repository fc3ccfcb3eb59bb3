# What `cmake --install` copies: the engine with its headers, CMake package and scenes, curtain_batch; with catkin the
# node, too.
if(NOT catkin_FOUND)
  include(GNUInstallDirs)
  set(curtain_bin ${CMAKE_INSTALL_BINDIR})
  set(curtain_lib ${CMAKE_INSTALL_LIBDIR})
  set(curtain_include ${CMAKE_INSTALL_INCLUDEDIR})
  set(curtain_share ${CMAKE_INSTALL_DATADIR}/curtain_sim)
  set(curtain_config ${curtain_lib}/cmake/curtain_sim)
else()
  set(curtain_bin ${CATKIN_PACKAGE_BIN_DESTINATION})
  set(curtain_lib ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(curtain_include ${CATKIN_GLOBAL_INCLUDE_DESTINATION})
  set(curtain_share ${CATKIN_PACKAGE_SHARE_DESTINATION})
  set(curtain_config ${curtain_share}/cmake)
endif()

install(TARGETS curtain_engine EXPORT curtain_sim-targets
  ARCHIVE DESTINATION ${curtain_lib}
  LIBRARY DESTINATION ${curtain_lib})
install(DIRECTORY include/curtain_sim DESTINATION ${curtain_include})
install(DIRECTORY config DESTINATION ${curtain_share})
install(TARGETS curtain_batch RUNTIME DESTINATION ${curtain_bin})
file(RELATIVE_PATH from_bin_to_lib /${curtain_bin} /${curtain_lib})
set_target_properties(curtain_batch PROPERTIES INSTALL_RPATH "$ORIGIN/${from_bin_to_lib}")
install(EXPORT curtain_sim-targets NAMESPACE curtain_sim:: DESTINATION ${curtain_config})

if(NOT catkin_FOUND)
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/curtain_simConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  #catkin_lint: ignore_once missing_file
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/curtain_simConfigVersion.cmake DESTINATION ${curtain_config})
  install(FILES cmake/curtain_sim-engine.cmake DESTINATION ${curtain_config} RENAME curtain_simConfig.cmake)
else()
  export(EXPORT curtain_sim-targets NAMESPACE curtain_sim::
    FILE ${CATKIN_DEVEL_PREFIX}/share/curtain_sim/cmake/curtain_sim-targets.cmake)
  install(TARGETS curtain_node RUNTIME DESTINATION ${curtain_bin})
  install(TARGETS curtain_nodelet LIBRARY DESTINATION ${curtain_lib})
  set_target_properties(curtain_node PROPERTIES INSTALL_RPATH "$ORIGIN/${from_bin_to_lib}")
  set_target_properties(curtain_nodelet PROPERTIES INSTALL_RPATH "$ORIGIN")
  catkin_install_python(PROGRAMS scripts/curtain_rviz scripts/demo_motion scripts/demo_robot scripts/demo_scenery
    scripts/live_figures scripts/sweep DESTINATION ${curtain_bin})
  install(DIRECTORY scripts/curtain_sweep DESTINATION ${curtain_bin} FILES_MATCHING PATTERN "*.py")
  install(DIRECTORY launch DESTINATION ${curtain_share})
  if(TARGET curtain_rviz)
    install(TARGETS curtain_rviz LIBRARY DESTINATION ${curtain_lib})
    set_target_properties(curtain_rviz PROPERTIES INSTALL_RPATH "$ORIGIN")
  endif()
  install(FILES nodelet_plugins.xml rviz_plugins.xml DESTINATION ${curtain_share})
endif()
