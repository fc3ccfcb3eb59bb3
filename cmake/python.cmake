# The Python module curtain_engine, where pybind11 and Python's headers are (Debian: pybind11-dev, python3-dev). A package of
# one extension, so that its types (__init__.pyi, py.typed) are found with it. It is for the Python that cmake finds, or
# -DPython3_EXECUTABLE=…; docs/python.md.
option(CURTAIN_PYTHON "Build the Python module where pybind11 is found" ON)
if(NOT CURTAIN_PYTHON OR CURTAIN_FUZZ OR CURTAIN_SANITIZE OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # Python itself is not watched
  return()
endif()
if(NOT Python3_Interpreter_FOUND)
  curtain_part("Python module" "no Python 3")
  return()
endif()
# The interpreter says where its headers are, how it names modules and what it calls the folder of packages; pybind11 is headers
# alone. Neither's CMake package is needed: these differ from one version to the next.
execute_process(COMMAND ${Python3_EXECUTABLE} -c "
import os, site, sysconfig
print(sysconfig.get_paths()['include'], sysconfig.get_config_var('EXT_SUFFIX'), os.path.basename(site.getsitepackages()[0]), sep=';')"
  OUTPUT_VARIABLE curtain_interpreter OUTPUT_STRIP_TRAILING_WHITESPACE)
list(GET curtain_interpreter 0 curtain_python_headers)
list(GET curtain_interpreter 1 curtain_python_suffix)
list(GET curtain_interpreter 2 curtain_python_packages)
find_path(CURTAIN_pybind11_HEADERS pybind11/pybind11.h HINTS ${curtain_python_headers})
mark_as_advanced(CURTAIN_pybind11_HEADERS)
if(NOT EXISTS ${curtain_python_headers}/Python.h)
  curtain_part("Python module" "no headers of ${Python3_EXECUTABLE}, ${curtain_python_headers}/Python.h (Debian: python3-dev)")
  return()
endif()
if(NOT CURTAIN_pybind11_HEADERS)
  curtain_part("Python module" "no pybind11 (Debian: pybind11-dev)")
  return()
endif()
curtain_part("Python module")

# Where Python looks below a prefix.
if(catkin_FOUND)
  set(curtain_python ${CATKIN_GLOBAL_PYTHON_DESTINATION})
  set(curtain_python_built ${CATKIN_DEVEL_PREFIX}/${curtain_python})
else()
  set(curtain_python lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/${curtain_python_packages})
  set(curtain_python_built ${CMAKE_CURRENT_BINARY_DIR}/python)
endif()

file(GLOB CURTAIN_PYTHON_SOURCES CONFIGURE_DEPENDS src/python/*.cpp)
add_library(curtain_python MODULE ${CURTAIN_PYTHON_SOURCES})
set_target_properties(curtain_python PROPERTIES PREFIX "" SUFFIX ${curtain_python_suffix} OUTPUT_NAME __init__ CXX_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${curtain_python_built}/curtain_engine)
target_include_directories(curtain_python PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_compile_definitions(curtain_python PRIVATE CURTAIN_VERSION="${PROJECT_VERSION}")
target_include_directories(curtain_python SYSTEM PRIVATE ${curtain_python_headers} ${CURTAIN_pybind11_HEADERS})
target_link_libraries(curtain_python PRIVATE curtain_engine curtain_warnings)
configure_file(src/python/__init__.pyi ${curtain_python_built}/curtain_engine/__init__.pyi COPYONLY)
configure_file(src/python/py.typed ${curtain_python_built}/curtain_engine/py.typed COPYONLY)  # type checkers ask for it
install(FILES src/python/__init__.pyi src/python/py.typed DESTINATION ${curtain_python}/curtain_engine)
install(TARGETS curtain_python LIBRARY DESTINATION ${curtain_python}/curtain_engine)
file(RELATIVE_PATH from_python_to_lib /${curtain_python}/curtain_engine /${curtain_lib})
set_target_properties(curtain_python PROPERTIES INSTALL_RPATH "$ORIGIN/${from_python_to_lib}")
