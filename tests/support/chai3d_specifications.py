"""The figures of CHAI3D 3.2.0 for each device, under the names that it has there.

The neighbors of the devices that have a preset are in the table as well: figures of
another model are told apart from a preset's own.
"""

import csv
import io

# Field `m_...` of `m_specifications` for each `m_modelName`; N, N·m, N/m, N·m/rad,
# N·s/m, N·m·s/rad, m. 0 of a rating means that the source does not know it.
_TABLE = """\
file,revision,modelName,maxLinearForce,maxAngularTorque,maxLinearStiffness,\
maxAngularStiffness,maxLinearDamping,maxAngularDamping,workspaceRadius,actuatedRotation
CDeltaDevices.cpp,2144,delta.3,20,0,5000,0,30,0,0.15,false
CDeltaDevices.cpp,2144,delta.6,20,0.2,5000,1,30,0,0.15,true
CDeltaDevices.cpp,2144,omega.3,12,0,5000,0,30,0,0.075,false
CDeltaDevices.cpp,2144,omega.6,12,0,5000,0,30,0,0.075,false
CDeltaDevices.cpp,2144,omega.7,12,0,5000,0,30,0,0.075,false
CDeltaDevices.cpp,2144,sigma.6+,12,0.2,4000,1,30,0.07,0.09,true
CDeltaDevices.cpp,2144,sigma.7,12,0.2,4000,1,30,0.07,0.075,true
CDeltaDevices.cpp,2144,Falcon,8,0,3000,0,20,0,0.04,false
CPhantomDevices.cpp,1938,Touch,3.3,0,400,0,4,0,0.075,false
CPhantomDevices.cpp,1938,PHANTOM Omni,3.3,0,700,0,5,0,0.1,false
CPhantomDevices.cpp,1938,PHANTOM Desktop,7.9,0,1000,0,5,0,0.1,false
CPhantomDevices.cpp,1938,PHANTOM Premium 1.5 6DOF,8.5,0.188,800,0.3,5,0.004,0.12,true
CPhantomDevices.cpp,1938,PHANTOM Premium 3.0 6DOF,22,0.188,1000,0.3,5,0.004,0.25,true
"""
SPECIFICATIONS = {
    row["modelName"].lower(): row for row in csv.DictReader(io.StringIO(_TABLE))
}


def find_specification(description):
    """Returns the row of the model with whose name a description begins."""
    words = description.lower()
    names = [name for name in SPECIFICATIONS if words.startswith(name)]
    (name,) = names
    return SPECIFICATIONS[name]
