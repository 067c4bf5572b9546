LAW(elastic)
LAW(elastic_1d)
LAW(multi_yield_j2)
