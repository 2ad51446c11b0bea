"""What the loops are called in tables."""

PACED = "drake_haptics, whole tick, paced"
OURS = "drake_haptics, whole tick"
NATIVE = "drake_haptics, native part"
# Bushing and point contact. Name -> contact solver of Drake.
STOCK = {
    "Drake, bushing, TAMSI": "tamsi",
    "Drake, bushing, SAP": "similar",
}
MUJOCO = "MuJoCo, mj_step"
