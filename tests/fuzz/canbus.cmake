kenaf_fuzzer(robot_bus_fuzz SOURCE robot_bus_fuzz.cpp LIBRARIES kenaf_canbus)
