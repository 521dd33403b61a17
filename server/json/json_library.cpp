#include <boost/json/src.hpp>  // the library, compiled once here
