#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace drake_haptics {

/// A UDP socket to one peer. The system drops packets of others. Only the
/// constructor and `Wait` block.
class UdpSocket {
 public:
  /// Opens a socket on a free port, to the first IPv4 address of the host, or
  /// to its first IPv6 address if it has no other. Waits until the name is
  /// resolved.
  /// @throws std::runtime_error if there is no such host, or no socket.
  UdpSocket(const std::string& host, std::uint16_t port);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  /// Sends one packet. If the system cannot send it now, it is lost, as on the
  /// network.
  void Send(std::span<const unsigned char> packet);

  /// Receives one packet, cut to the size of the buffer.
  /// @returns the packet's size; −1 if none is waiting.
  std::ptrdiff_t Receive(std::span<unsigned char> buffer);

  /// Waits until a packet is there, or for `timeout` s, rounded up to ms.
  void Wait(double timeout) const;

  /// Our own port.
  std::uint16_t local_port() const;

 private:
  int descriptor_ = -1;
};

}  // namespace drake_haptics
