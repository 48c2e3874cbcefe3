foreach(fuzzer robot_description_fuzz world_description_fuzz)
  kenaf_fuzzer(${fuzzer} SOURCE ${CMAKE_CURRENT_LIST_DIR}/${fuzzer}.cpp LIBRARIES kenaf_physics)
endforeach()
