# The Python module curtain_engine, where pybind11 and Python's headers are (Debian: pybind11-dev, python3-dev). A package of
# one extension, so that its types (__init__.pyi, py.typed) are found with it. It is for the Python that cmake finds, or
# -DPython3_EXECUTABLE=…; docs/python.md.
option(CURTAIN_PYTHON "Build the Python module where pybind11 is found" ON)
if(NOT CURTAIN_PYTHON OR CURTAIN_FUZZ OR CURTAIN_SANITIZE OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # Python itself is not watched
  return()
endif()
if(Python3_Development.Module_FOUND)
  find_package(pybind11 2.6 QUIET)
endif()
if(NOT pybind11_FOUND)
  message(STATUS "curtain_sim: no pybind11 found, building without the Python module (Debian: pybind11-dev, python3-dev)")
  return()
endif()
message(STATUS "curtain_sim: building the Python module with pybind11 ${pybind11_VERSION} for ${Python3_EXECUTABLE}")

# Where Python looks below a prefix; Debian has folders of its own.
if(catkin_FOUND)
  set(curtain_python ${CATKIN_GLOBAL_PYTHON_DESTINATION})
  set(curtain_python_built ${CATKIN_DEVEL_PREFIX}/${curtain_python})
else()
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sysconfig; print(any(n.startswith('deb_') for n in sysconfig.get_scheme_names()))"
    OUTPUT_VARIABLE debian OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(site site-packages)
  if(debian STREQUAL "True")
    set(site dist-packages)
  endif()
  set(curtain_python lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/${site})
  set(curtain_python_built ${CMAKE_CURRENT_BINARY_DIR}/python)
endif()

file(GLOB CURTAIN_PYTHON_SOURCES CONFIGURE_DEPENDS src/python/*.cpp)
add_library(curtain_python MODULE ${CURTAIN_PYTHON_SOURCES})
pybind11_extension(curtain_python)
set_target_properties(curtain_python PROPERTIES OUTPUT_NAME __init__ CXX_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${curtain_python_built}/curtain_engine)
target_include_directories(curtain_python PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_compile_definitions(curtain_python PRIVATE CURTAIN_VERSION="${PROJECT_VERSION}")
target_link_libraries(curtain_python PRIVATE pybind11::module curtain_engine curtain_warnings)
configure_file(src/python/__init__.pyi ${curtain_python_built}/curtain_engine/__init__.pyi COPYONLY)
file(TOUCH ${curtain_python_built}/curtain_engine/py.typed)  # type checkers ask for it
install(FILES src/python/__init__.pyi ${curtain_python_built}/curtain_engine/py.typed DESTINATION ${curtain_python}/curtain_engine)
install(TARGETS curtain_python LIBRARY DESTINATION ${curtain_python}/curtain_engine)
file(RELATIVE_PATH from_python_to_lib /${curtain_python}/curtain_engine /${curtain_lib})
set_target_properties(curtain_python PROPERTIES INSTALL_RPATH "$ORIGIN/${from_python_to_lib}")
