// Boost.Asio is compiled once for the whole project (BOOST_ASIO_SEPARATE_COMPILATION): whoever talks to sockets links
// linefeed::asio, and no two libraries bring their own copy into one program.
#include <boost/asio/impl/src.hpp>
