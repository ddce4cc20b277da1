"""The studio as a server for Hops, the component of Grasshopper that asks other programs."""
