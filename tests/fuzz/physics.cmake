foreach(fuzzer height_map_fuzz mesh_file_fuzz polygon_fuzz robot_description_fuzz world_description_fuzz world_includes_fuzz)
  kenaf_fuzzer(${fuzzer} SOURCE ${CMAKE_CURRENT_LIST_DIR}/${fuzzer}.cpp LIBRARIES kenaf_physics)
endforeach()
