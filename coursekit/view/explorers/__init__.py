"""The explorers of the six notebooks: small compositions of a scene, controls, a text and plots."""
