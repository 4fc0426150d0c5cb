DefineConstant[ n = 6 ];
a=1; b=2; c=3;
Function Ring
  p0=newp; Point(p0)={0,0,0};
  For q In {0:3}
    pa[q]=newp; Point(pa[q])={ra*Cos(q*Pi/2),ra*Sin(q*Pi/2),0};
    pb[q]=newp; Point(pb[q])={rb*Cos(q*Pi/2),rb*Sin(q*Pi/2),0};
  EndFor
  For q In {0:3}
    ca[q]=newl; Circle(ca[q])={pa[q],p0,pa[(q+1)%4]};
    cb[q]=newl; Circle(cb[q])={pb[q],p0,pb[(q+1)%4]};
    cr[q]=newl; Line(cr[q])={pa[q],pb[q]};
    Transfinite Curve{ca[q],cb[q]}=m+1; Transfinite Curve{cr[q]}=k+1;
  EndFor
  For q In {0:3}
    l=newll; Curve Loop(l)={ca[q],cr[(q+1)%4],-cb[q],-cr[q]};
    s[q]=news; Plane Surface(s[q])={l}; Transfinite Surface{s[q]}; Recombine Surface{s[q]};
  EndFor
Return
ra=a; rb=b; m=n; k=4; Call Ring;
Physical Surface("shaft")={s[]}; Physical Curve("bore")={ca[]}; Physical Curve("seat")={cb[]};
ra=b; rb=c; m=n+1; k=4; Call Ring;
Physical Surface("ring")={s[]}; Physical Curve("hole")={ca[]}; Physical Curve("rim")={cb[]};
