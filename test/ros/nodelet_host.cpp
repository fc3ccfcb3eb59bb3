// SPDX-License-Identifier: BSD-3-Clause
//
// Runs nodelets of other packages straight from their libraries. Debian's packages to run them have no description of
// their plugins, without which nodelet's manager does not find them; those that have one ask for hundreds more.
//
//   curtain_nodelet_host LIBRARY CLASS NAME [LIBRARY CLASS NAME …]
//
// 0: asked to end; 77: a library is not there.
#include <nodelet/loader.h>
#include <nodelet/nodelet.h>
#include <ros/init.h>
#include <ros/names.h>

#include <class_loader/multi_library_class_loader.hpp>
#include <cstdio>
#include <memory>

int main(int argc, char** argv) {
  ros::init(argc, argv, "nodelet_host");
  class_loader::MultiLibraryClassLoader libraries(false);
  const auto create = [&libraries](const std::string& type) {
    const auto kept = libraries.createInstance<nodelet::Nodelet>(type);  // of std, nodelet has boost's
    return boost::shared_ptr<nodelet::Nodelet>(kept.get(), [kept](nodelet::Nodelet*) {});
  };
  try {
    for (int i = 1; i + 2 < argc; i += 3) libraries.loadLibrary(argv[i]);
  } catch (const class_loader::ClassLoaderException& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 77;
  }
  nodelet::Loader loader(create);
  for (int i = 1; i + 2 < argc; i += 3) {
    if (!loader.load(ros::names::resolve(argv[i + 2]), argv[i + 1], ros::names::getRemappings(), {})) return 1;
  }
  ros::spin();
  loader.clear();
  return 0;
}
