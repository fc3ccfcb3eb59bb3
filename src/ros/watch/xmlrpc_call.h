// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: calls to the master's and to this node's own XML-RPC interface that end. Those of roscpp wait for an answer
// for ever: a master that is there but does not answer (stopped, swapped out) would take the caller with it.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

namespace curtain_ros {

/// What a call gave.
struct XmlRpcAnswer {
  bool answered = false;  ///< false: nobody there, or not in time
  bool success = false;   ///< the answer's code says so
  /// What was asked for; the whole answer, without success, where it is not of the form [code, message, value]: roscpp
  /// gives its bus statistics so.
  XmlRpc::XmlRpcValue value;
};

/// Calls a method; thread-safe.
///   uri         http://host:port
///   parameters  after the first, which is this node's name
/// Comes back within about two seconds (a host name that is slow to look up aside).
XmlRpcAnswer callXmlRpc(const std::string& uri, const std::string& method,
                        const std::vector<XmlRpc::XmlRpcValue>& parameters);

}  // namespace curtain_ros
