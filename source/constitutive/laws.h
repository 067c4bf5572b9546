LAW(elastic)
LAW(multi_yield_j2)
